//! The backends before the oracle: every answer to rays of many kinds. Run it with `--nocapture` for the tables.

use super::scenes::{self, Scene};
use crate::support::effort;
use glint::accel::oracle::{Class, Judgement, Oracle};
use glint::accel::{Accelerator, AcceptAll};
use glint::geometry::{Hit, Ray};

/// How a backend did on the rays of one kind.
struct Table {
    rays: usize,
    /// For each class, how often.
    counts: [usize; Class::ALL.len()],
    /// The first answer that rounding does not excuse, and how many there are.
    unlawful: Option<(Ray, Hit, Judgement)>,
    unlawful_count: usize,
    /// Of those, leaks through closed surfaces.
    leaks: usize,
    /// The largest distance from an edge on whose wrong side an answer is, as a part of the band.
    farthest: f64,
}

impl Table {
    fn of<A: Accelerator>(backend: &A, oracle: &Oracle, rays: &[Ray]) -> Self {
        let mut hits = vec![Hit::MISS; rays.len()];
        backend.closest(rays, &AcceptAll, &mut hits);
        let mut table = Self {
            rays: rays.len(),
            counts: [0; Class::ALL.len()],
            unlawful: None,
            unlawful_count: 0,
            leaks: 0,
            farthest: 0.0,
        };
        for (ray, hit) in rays.iter().zip(hits) {
            let judgement = oracle.judge(ray, &AcceptAll, hit.id);
            table.counts[judgement.class as usize] += 1;
            let edges = [judgement.outside, judgement.overlooked.map(|o| o.edge)];
            let farthest = edges.iter().flatten().map(|edge| edge.ratio());
            table.farthest = farthest.fold(table.farthest, f64::max);
            if !judgement.is_lawful() {
                table.unlawful.get_or_insert((*ray, hit, judgement));
                table.unlawful_count += 1;
                table.leaks += usize::from(judgement.overlooked.is_some_and(|o| !o.silhouette));
            }
        }
        table
    }

    fn count(&self, class: Class) -> usize {
        self.counts[class as usize]
    }

    #[expect(clippy::print_stdout, reason = "the table is what the run is for")]
    fn print(&self, title: &str) {
        let named = Class::ALL.iter().filter(|(_, class)| self.count(*class) > 0);
        let counts: Vec<_> =
            named.map(|(name, class)| format!("{name} {}", self.count(*class))).collect();
        let Self { rays, farthest, unlawful_count, leaks, .. } = self;
        println!(
            "{title}: {rays} rays: {}; at most {farthest:.2} of the band from an edge; {unlawful_count} not \
             excused, {leaks} of them leaks",
            counts.join(", ")
        );
        if let Some((ray, hit, judgement)) = &self.unlawful {
            println!("    the first: {ray:?} answered {:?}: {judgement:?}", hit.id);
        }
    }
}

/// Both kinds of rays through a scene.
fn tables<A: Accelerator>(name: &str, backend: &A, scene: &Scene, oracle: &Oracle) -> [Table; 2] {
    [("at random", false, 10_000), ("aimed at edges", true, 2000)].map(|(kind, aimed, n)| {
        let rays = scenes::rays(&scene.geometry, effort(n, 10 * n), aimed);
        let table = Table::of(backend, oracle, &rays);
        table.print(&format!("{name}, {}, {kind}", scene.name));
        table
    })
}

/// Never wrong but for the rounding of its kernel, and never through a closed surface.
#[cfg(feature = "bvh")]
#[test]
fn the_in_house_bvh_is_never_wrong_outside_of_its_band() {
    use glint::accel::bvh::Bvh;
    let mut excused = 0;
    scenes::each(|scene, oracle| {
        let bvh = Bvh::build(scene.geometry.clone(), 2).expect("it builds");
        let [random, aimed] = tables("bvh", &bvh, scene, oracle);
        for table in [&random, &aimed] {
            assert!(table.unlawful.is_none(), "{}: {:?}", scene.name, table.unlawful);
        }
        let right = [Class::Right, Class::Tie, Class::NearTie].map(|class| random.count(class));
        assert!(1000 * right.iter().sum::<usize>() >= 998 * random.rays, "{}", scene.name);
        excused += aimed.count(Class::Neighbour) + aimed.count(Class::Missed);
    });
    // Or these rays would show nothing.
    assert!(excused > 1000, "{excused}");
}

/// Embree promises less, and is judged for comparison: right on nearly all rays that are aimed at nothing.
#[cfg(feature = "embree")]
#[test]
fn embree_is_right_where_no_edge_is_near() {
    use glint::accel::embree::EmbreeAccelerator;
    scenes::each(|scene, oracle| {
        let embree = EmbreeAccelerator::build(scene.geometry.clone(), 2).expect("it builds");
        let [random, _] = tables("embree", &embree, scene, oracle);
        let right = [Class::Right, Class::Tie, Class::NearTie].map(|class| random.count(class));
        if scene.is_ordinary {
            assert!(1000 * right.iter().sum::<usize>() >= 998 * random.rays, "{}", scene.name);
        }
    });
}
