//! Builds and rays of every kind on one thread, for regressions: Embree's robust mode a ray at a time, and the
//! in-house BVH with batches, on a generated grove. `cargo bench --bench accel`; for a comparison that is to be
//! published take `glint bench`, which checks answers and lets the two take turns.

use criterion::{BatchSize, BenchmarkGroup, Criterion, Throughput, measurement::WallTime};
#[cfg(feature = "bvh")]
use glint::accel::bvh::Bvh;
#[cfg(feature = "embree")]
use glint::accel::embree::{BareEmbree, EmbreeAccelerator, EmbreeCall, EmbreeVariant};
use glint::accel::{Accelerator, AcceptAll};
use glint::error::{Error, Result};
use glint::generate::{Kind, Model, write_obj};
use glint::geometry::{Hit, Ray};
use glint::load::load_scene;
use glint::math::DVec3;
#[cfg(feature = "embree")]
use glint::os::Isa;
use glint::scene::{Camera, Projection};
#[cfg(feature = "embree")]
use glint::study::bench::Query;
#[cfg(feature = "bvh")]
use glint::study::bench::{BATCH, InHouse, Tracer};
use glint::study::bench::{RayKind, RaySet, RaySource};
use glint::world::World;

const TRIANGLES: u64 = 200_000;
const RAYS: usize = 1 << 15;

fn grove() -> Result<World> {
    let folder = tempfile::tempdir().map_err(|e| Error::io("", "create", e))?;
    let path = folder.path().join("grove.obj");
    let failed = |e| Error::io(&path, "write", e);
    let mut file = std::io::BufWriter::new(std::fs::File::create(&path).map_err(failed)?);
    let model = Model { kind: Kind::Foliage, triangles: TRIANGLES, seed: 0 };
    write_obj(&model, "grove.mtl", &mut file, &mut |_| Ok(())).map_err(failed)?;
    drop(file);
    World::compile(load_scene(&path)?)
}

fn ray_sets(world: &World, accelerator: &impl Accelerator) -> Result<Vec<RaySet>> {
    let to = world.origin + world.bounds.center().as_dvec3();
    let from = to + f64::from(world.bounds.bounding_radius()) * DVec3::new(0.6, 0.4, 1.0);
    let projection = Projection::Perspective { vertical_fov: 35.0 };
    let camera =
        Camera { name: "bench".into(), location: None, from, to, up: DVec3::Y, projection };
    let closest = |rays: &[Ray]| {
        let mut hits = vec![Hit::MISS; rays.len()];
        accelerator.closest(rays, &AcceptAll, &mut hits);
        hits
    };
    let source = RaySource { world, cameras: &[camera], closest: &closest };
    source.generate(&RayKind::ALL.map(|(_, kind)| kind), RAYS)
}

#[cfg(feature = "embree")]
fn trace_embree(group: &mut BenchmarkGroup<'_, WallTime>, embree: &BareEmbree, set: &RaySet) {
    let mut rays = match set.kind.query() {
        Query::Closest => embree.closest(EmbreeCall::Single),
        Query::AnyHit => match embree.occluded(EmbreeCall::Single) {
            Some(rays) => rays,
            None => return,
        },
    };
    group.bench_function("embree", |bencher| {
        bencher.iter_custom(|iterations| {
            let mut total = std::time::Duration::ZERO;
            for _ in 0..iterations {
                rays.load(&set.rays);
                let start = std::time::Instant::now();
                rays.trace();
                total += start.elapsed();
            }
            total
        });
    });
}

#[cfg(feature = "bvh")]
fn trace_bvh(group: &mut BenchmarkGroup<'_, WallTime>, bvh: &Bvh, set: &RaySet) {
    let tracer = InHouse { accelerator: bvh, slice: BATCH };
    let Some(mut rays) = tracer.batch(set.kind.query()) else { return };
    rays.load(&set.rays);
    group.bench_function("bvh", |bencher| bencher.iter(|| rays.trace()));
}

fn run(criterion: &mut Criterion) -> Result<()> {
    let world = grove()?;
    let geometry = || world.geometry.clone();

    let mut group = criterion.benchmark_group("build");
    group.sample_size(10).throughput(Throughput::Elements(TRIANGLES));
    #[cfg(feature = "embree")]
    group.bench_function("embree", |bencher| {
        let build = |geometry| EmbreeAccelerator::build(geometry, 1);
        bencher.iter_batched(geometry, build, BatchSize::PerIteration);
    });
    #[cfg(feature = "bvh")]
    group.bench_function("bvh", |bencher| {
        let build = |geometry| Bvh::build(geometry, 1);
        bencher.iter_batched(geometry, build, BatchSize::PerIteration);
    });
    group.finish();

    #[cfg(feature = "embree")]
    let embree = BareEmbree::build(geometry(), 1, EmbreeVariant::PRODUCTION, Isa::detect())?;
    #[cfg(feature = "bvh")]
    let bvh = Bvh::build(geometry(), 1)?;
    #[cfg(feature = "embree")]
    let sets = ray_sets(&world, &EmbreeAccelerator::build(geometry(), 1)?)?;
    #[cfg(not(feature = "embree"))]
    let sets = ray_sets(&world, &bvh)?;
    for set in &sets {
        let mut group = criterion.benchmark_group(set.kind.name());
        group.throughput(Throughput::Elements(set.rays.len() as u64));
        #[cfg(feature = "embree")]
        trace_embree(&mut group, &embree, set);
        #[cfg(feature = "bvh")]
        trace_bvh(&mut group, &bvh, set);
        group.finish();
    }
    Ok(())
}

fn main() -> Result<()> {
    let mut criterion = Criterion::default().configure_from_args();
    run(&mut criterion)?;
    criterion.final_summary();
    Ok(())
}
