//! Voronoi cells of points in the unit square, on the torus or bounded by the square; Lloyd's relaxation moves
//! points with them.
//!
//! The triangulation is the crate spade's, with exact predicates. The two domains differ in the ghosts that are
//! triangulated along: copies of points beyond the opposite edge, or mirror images beyond the same one.

use spade::handles::VoronoiVertex;
use spade::{DelaunayTriangulation, HasPosition, Point2, Triangulation};

/// What is beyond the edges of the unit square.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Domain {
    /// The opposite edge.
    Torus,
    /// Nothing: cells end there.
    Square,
}

/// A point's cell.
#[derive(Clone, Debug, Default)]
pub struct Cell {
    /// Corners in counter-clockwise order, on the torus around the point itself, so that they may leave the square. Empty
    /// for all but one of points in the same place.
    pub corners: Vec<[f64; 2]>,
}

/// A point or one of its ghosts.
#[derive(Clone, Copy)]
struct Site {
    position: Point2<f64>,
    /// Of the point; `None` for a ghost.
    index: Option<usize>,
}

impl HasPosition for Site {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.position
    }
}

/// How far points are kept from the edges of a bounded square.
const EDGE: f64 = 1e-9;

/// The cell of each of `points`, which are in [0, 1)^2 and finite.
pub fn cells(points: &[[f64; 2]], domain: Domain) -> Vec<Cell> {
    // Ghosts within a margin are enough if no cell reaches farther than half of it.
    let mut margin = (4.0 / (points.len().max(1) as f64).sqrt()).min(1.0);
    loop {
        let (cells, is_closed) = cells_with_margin(points, domain, margin);
        let farthest =
            cells.iter().zip(points).map(|(cell, p)| cell.radius_squared(*p)).fold(0.0, f64::max);
        if margin == 1.0 || (is_closed && 4.0 * farthest <= margin * margin) {
            return cells;
        }
        margin = (2.0 * margin).min(1.0);
    }
}

impl Cell {
    /// Squared distance of the farthest corner from its point.
    fn radius_squared(&self, point: [f64; 2]) -> f64 {
        let squared = |c: &[f64; 2]| (c[0] - point[0]).powi(2) + (c[1] - point[1]).powi(2);
        self.corners.iter().map(squared).fold(0.0, f64::max)
    }

    /// Area, centroid relative to `point`, and the integral of the squared distance from `point`.
    fn moments(&self, point: [f64; 2]) -> (f64, [f64; 2], f64) {
        let (mut area, mut first, mut second) = (0.0, [0.0; 2], 0.0);
        let corner = |i: usize| {
            let c = self.corners[i % self.corners.len()];
            [c[0] - point[0], c[1] - point[1]]
        };
        // Triangles between the point and each edge.
        for i in 0..self.corners.len() {
            let (p, q) = (corner(i), corner(i + 1));
            let triangle = 0.5 * (p[0] * q[1] - p[1] * q[0]);
            area += triangle;
            for k in 0..2 {
                first[k] += triangle * (p[k] + q[k]) / 3.0;
                second += triangle * (p[k] * p[k] + p[k] * q[k] + q[k] * q[k]) / 6.0;
            }
        }
        (area, first.map(|m| if area > 0.0 { m / area } else { 0.0 }), second)
    }
}

/// The cells that ghosts within a margin leave, and whether all are bounded.
fn cells_with_margin(points: &[[f64; 2]], domain: Domain, margin: f64) -> (Vec<Cell>, bool) {
    // A point on an edge would be its own mirror image.
    let points: Vec<_> = match domain {
        // Coordinates too small to be triangulated are as good as 0.
        Domain::Torus => points.iter().map(|p| p.map(|c| if c < EDGE { 0.0 } else { c })).collect(),
        Domain::Square => points.iter().map(|p| p.map(|c| c.clamp(EDGE, 1.0 - EDGE))).collect(),
    };
    let ghosts = points.iter().flat_map(|p| match domain {
        Domain::Torus => copies(*p, margin),
        Domain::Square => mirrored(*p, margin),
    });
    let site = |p: [f64; 2], index| Site { position: Point2::new(p[0], p[1]), index };
    let own = points.iter().enumerate().map(|(i, p)| site(*p, Some(i)));
    let sites = own.chain(ghosts.map(|p| site(p, None))).collect();
    let mut cells = vec![Cell::default(); points.len()];
    // It refuses coordinates that are not finite or below 1e-42, and there are none.
    let Ok(triangulation) = DelaunayTriangulation::<Site>::bulk_load_stable(sites) else {
        return (cells, true);
    };
    let mut is_closed = true;
    for vertex in triangulation.vertices() {
        let Some(index) = vertex.data().index else { continue };
        let edges = vertex.as_voronoi_face().adjacent_edges();
        let corners = edges.filter_map(|edge| match edge.from() {
            VoronoiVertex::Inner(face) => Some(face.circumcenter()),
            VoronoiVertex::Outer(_) => {
                is_closed = false;
                None
            }
        });
        cells[index].corners = corners.map(|corner| [corner.x, corner.y]).collect();
    }
    (cells, is_closed)
}

/// The copies of a point that are within `margin` of the square.
fn copies(p: [f64; 2], margin: f64) -> Vec<[f64; 2]> {
    let offsets = [-1.0, 0.0, 1.0];
    let near = |c: f64| -margin <= c && c <= 1.0 + margin;
    offsets
        .iter()
        .flat_map(|dy| offsets.map(|dx| (dx, *dy)))
        .filter(|offset| *offset != (0.0, 0.0))
        .map(|(dx, dy)| [p[0] + dx, p[1] + dy])
        .filter(|ghost| ghost.iter().all(|c| near(*c)))
        .collect()
}

/// The images of a point in the edges that are within `margin` of it.
fn mirrored(p: [f64; 2], margin: f64) -> Vec<[f64; 2]> {
    let [x, y] = p;
    let images = [([-x, y], x), ([2.0 - x, y], 1.0 - x), ([x, -y], y), ([x, 2.0 - y], 1.0 - y)];
    images.into_iter().filter(|(_, d)| *d <= margin).map(|(image, _)| image).collect()
}

/// Points moved to the centroids of their cells, again and again: Lloyd's relaxation, towards a centroidal Voronoi
/// tessellation. `energies` gets what each step began with: the integral of the squared distance to the nearest
/// point over the square, times the number of points. It never rises. Ends when a step gains less than `tolerance`
/// of it, or after `steps`.
///
/// Source: S. P. Lloyd, "Least squares quantization in PCM", IEEE Transactions on Information Theory 28(2), 1982;
/// Q. Du, V. Faber and M. Gunzburger, "Centroidal Voronoi Tessellations", SIAM Review 41(4), 1999.
pub fn relax(points: &mut [[f64; 2]], domain: Domain, steps: u32, tolerance: f64) -> Vec<f64> {
    let mut energies = Vec::new();
    for _ in 0..steps {
        let mut energy = 0.0;
        let cells = cells(points, domain);
        for (point, cell) in points.iter_mut().zip(&cells) {
            let (_, step, second) = cell.moments(*point);
            energy += second;
            *point = [0, 1].map(|k| inside(point[k] + step[k]));
        }
        energies.push(energy * points.len() as f64);
        if let [.., before, last] = energies[..]
            && before - last < tolerance * before
        {
            break;
        }
    }
    energies
}

/// A coordinate brought back around the torus; rounding does not make it 1. Centroids in the square are inside anyway.
fn inside(x: f64) -> f64 {
    let x = x - x.floor();
    if x < 1.0 { x } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::CounterRng;

    fn random(count: usize, seed: u64) -> Vec<[f64; 2]> {
        let mut rng = CounterRng::new(seed);
        (0..count).map(|_| [f64::from(rng.unit()), f64::from(rng.unit())]).collect()
    }

    fn distance_squared(a: [f64; 2], b: [f64; 2], domain: Domain) -> f64 {
        let along = |k: usize| {
            let d = (a[k] - b[k]).abs();
            if domain == Domain::Torus { d.min(1.0 - d) } else { d }
        };
        along(0).powi(2) + along(1).powi(2)
    }

    #[test]
    fn cells_fill_the_square_and_corners_are_nearest_to_their_points() {
        for domain in [Domain::Torus, Domain::Square] {
            for (count, seed) in [(1, 0), (2, 1), (3, 2), (5, 3), (50, 4), (400, 5)] {
                let points = random(count, seed);
                let cells = cells(&points, domain);
                let area: f64 = cells.iter().zip(&points).map(|(c, p)| c.moments(*p).0).sum();
                assert!((area - 1.0).abs() < 1e-9, "{domain:?} {count}: area {area}");
                for (cell, point) in cells.iter().zip(&points) {
                    for corner in &cell.corners {
                        let own = (corner[0] - point[0]).powi(2) + (corner[1] - point[1]).powi(2);
                        let wrapped = match domain {
                            Domain::Torus => corner.map(inside),
                            Domain::Square => *corner,
                        };
                        let nearest = points.iter().map(|p| distance_squared(*p, wrapped, domain));
                        let nearest = nearest.fold(f64::INFINITY, f64::min);
                        assert!(
                            (own - nearest).abs() < 1e-9,
                            "{domain:?} {count}: {own} {nearest}"
                        );
                    }
                }
            }
        }
    }

    /// Points in one corner, in one place, on the edges, and on a grid, where four cells meet at each corner.
    #[test]
    fn awkward_points_have_cells_too() {
        let clustered = random(30, 0).iter().map(|p| p.map(|c| 0.01 * c)).collect::<Vec<_>>();
        let same = vec![[0.25, 0.75]; 7];
        let edges = vec![[0.0, 0.0], [0.5, 0.0], [0.0, 0.5]];
        let grid: Vec<_> = (0..64).map(|i| [(i % 8) as f64 / 8.0, (i / 8) as f64 / 8.0]).collect();
        for points in [clustered, same, edges, grid] {
            for domain in [Domain::Torus, Domain::Square] {
                let cells = cells(&points, domain);
                let area: f64 = cells.iter().zip(&points).map(|(c, p)| c.moments(*p).0).sum();
                assert!((area - 1.0).abs() < 1e-6, "{domain:?} {points:?}: {area}");
            }
        }
    }

    /// The moments against sums over a fine raster of nearest points.
    #[test]
    fn moments_are_integrals_over_the_nearest_points() {
        const SIDE: usize = 400;
        for domain in [Domain::Torus, Domain::Square] {
            let points = random(9, 3);
            let cells = cells(&points, domain);
            let exact: f64 = cells.iter().zip(&points).map(|(c, p)| c.moments(*p).2).sum();
            let mut sum = 0.0;
            for i in 0..SIDE * SIDE {
                let at = [i % SIDE, i / SIDE].map(|c| (c as f64 + 0.5) / SIDE as f64);
                let nearest = points.iter().map(|p| distance_squared(*p, at, domain));
                sum += nearest.fold(f64::INFINITY, f64::min) / (SIDE * SIDE) as f64;
            }
            assert!((exact / sum - 1.0).abs() < 1e-4, "{domain:?}: {exact} {sum}");
        }
    }

    /// The energy never rises, and nears that of hexagons: 5 / (18 sqrt 3) for cells of area 1.
    #[test]
    fn relaxation_lowers_the_energy_towards_that_of_hexagons() {
        let hexagons = 5.0 / (18.0 * 3.0_f64.sqrt());
        for domain in [Domain::Torus, Domain::Square] {
            let mut points = random(200, 1);
            let energies = relax(&mut points, domain, 300, 0.0);
            assert!(
                energies.windows(2).all(|pair| pair[1] <= pair[0] * (1.0 + 1e-12)),
                "{domain:?}"
            );
            let last = energies[energies.len() - 1];
            let edges = if domain == Domain::Torus { 1.04 } else { 1.15 };
            assert!(last < edges * hexagons, "{domain:?}: {}", last / hexagons);
            assert!(domain == Domain::Square || last > hexagons);
        }
    }
}
