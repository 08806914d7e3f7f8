//! The builder on what is out to break it, held to the work that it may do and the tree that it must make.

use super::reinsert::MOST_DEPTH;
use super::{Anything, BinaryTree, Kind, PrimitiveBox, Quality, build, half_area};
use crate::geometry::Aabb;
use crate::math::Vec3;
use crate::sampling::CounterRng;

const QUALITIES: [Quality; 3] = [Quality::Fast, Quality::Default, Quality::High];
/// More than one thread builds over alone.
const N: usize = 70_000;

fn primitives(boxes: &[Aabb]) -> Vec<PrimitiveBox> {
    boxes.iter().zip(0..).map(|(b, id)| PrimitiveBox::new(b, id)).collect()
}

fn around(center: Vec3, size: f32) -> Aabb {
    Aabb { min: center - Vec3::splat(size), max: center + Vec3::splat(size) }
}

/// What splitting took: how often primitives were handed down a level, on average. After checking that each is in one
/// full enough leaf, within the boxes above it.
fn levels(tree: &BinaryTree, boxes: &[Aabb], leaf_size: u32) -> f64 {
    let mut seen = vec![false; boxes.len()];
    let mut work = 0;
    let mut stack = vec![(0, 0)];
    while let Some((place, depth)) = stack.pop() {
        let node = tree.nodes[place as usize];
        assert!(depth <= MOST_DEPTH);
        match node.kind() {
            Kind::Inner(children) => {
                let [left, right] = children.map(|child| tree.nodes[child as usize].bounds());
                let both = left.union(right);
                assert!(node.bounds().min == both.min && node.bounds().max == both.max);
                stack.extend(children.map(|child| (child, depth + 1)));
            }
            Kind::Leaf { start, end } => {
                assert!(start < end && end - start <= leaf_size);
                work += u64::from(depth) * u64::from(end - start);
                for &id in &tree.order[start as usize..end as usize] {
                    let (outer, inner) = (node.bounds(), boxes[id as usize]);
                    assert!(outer.min.cmple(inner.min).all() && outer.max.cmpge(inner.max).all());
                    assert!(!std::mem::replace(&mut seen[id as usize], true), "twice in a leaf");
                }
            }
        }
    }
    assert!(seen.iter().all(|&seen| seen), "not in any leaf");
    work as f64 / boxes.len() as f64
}

/// Surface of all inner nodes over that of the root.
fn cost(tree: &BinaryTree) -> f64 {
    let inner = tree.nodes.iter().filter(|node| matches!(node.kind(), Kind::Inner(_)));
    let area: f64 = inner.map(|node| f64::from(half_area(&node.bounds()))).sum();
    area / f64::from(half_area(&tree.nodes[0].bounds()))
}

/// Whatever there is, no primitive is handed down more often than in a tree of halves, plus the levels that may fail
/// to halve.
#[test]
fn no_input_takes_quadratic_work() {
    let mut rng = CounterRng::new(0);
    let mut point = || Vec3::new(rng.unit(), rng.unit(), rng.unit());
    let mut from = |make: &mut dyn FnMut(f32, Vec3) -> Aabb| -> Vec<Aabb> {
        (0..N).map(|i| make(i as f32 / N as f32, point())).collect()
    };
    let one = Vec3::ONE;
    // With the levels that each may take. A tree of halves has 14.2 above leaves of four; a series, on which halving begins late,
    // 48 more.
    let cases = [
        ("equal", 20.0, from(&mut |_, _| around(one, 1.0))),
        ("concentric", 20.0, from(&mut |x, _| around(Vec3::ZERO, 1.0 + x))),
        ("points", 20.0, from(&mut |_, p| around(p, 0.0))),
        ("flat", 20.0, from(&mut |_, p| around(p.with_y(0.0), 0.0))),
        ("a line", 20.0, from(&mut |x, _| around(one * x, 1e-4))),
        ("a series", 62.0, from(&mut |x, _| around(Vec3::X * 10.0_f32.powf(70.0 * x - 35.0), 0.0))),
        (
            "all in one corner",
            20.0,
            from(&mut |x, p| around(if x == 0.0 { one * 1e9 } else { p }, 0.1)),
        ),
        ("large", 20.0, from(&mut |x, p| around(p, if x < 0.1 { 9.0 } else { 1e-3 }))),
        ("overlapping", 20.0, from(&mut |_, p| around(p, 1.0))),
        ("denormal", 20.0, from(&mut |_, p| around(p * 1e-40, 0.0))),
        (
            "overflowing",
            20.0,
            from(&mut |x, p| around((p - 0.5) * 3e38 * 1.2, if x < 0.5 { 0.0 } else { 1e38 })),
        ),
        (
            "infinite extent",
            20.0,
            from(&mut |x, p| around(p + one * if x < 0.5 { 3e38 } else { -3e38 }, 0.0)),
        ),
    ];
    for (name, most, boxes) in &cases {
        for quality in QUALITIES {
            let levels = levels(&build(primitives(boxes), &Anything(4), quality), boxes, 4);
            assert!(levels <= *most, "{name}, {quality:?}: {levels}");
        }
    }
}

#[test]
fn few_primitives_of_any_number_make_a_tree() {
    let mut rng = CounterRng::new(0);
    for n in 0..70 {
        let mut point = || Vec3::new(rng.unit(), rng.unit(), rng.unit());
        let boxes: Vec<_> = (0..n).map(|_| around(point(), 0.1)).collect();
        for (quality, leaf_size) in QUALITIES.into_iter().flat_map(|q| [(q, 1), (q, 4), (q, 8)]) {
            let tree = build(primitives(&boxes), &Anything(leaf_size), quality);
            if n > 0 {
                levels(&tree, &boxes, leaf_size as u32);
            }
            assert_eq!((tree.nodes.is_empty(), tree.order.len()), (n == 0, n));
        }
    }
}

/// Large boxes between small ones in clusters, where a builder from the top decides too early.
#[test]
fn more_work_makes_a_cheaper_tree() {
    let mut rng = CounterRng::new(0);
    let mut point = || Vec3::new(rng.unit(), rng.unit(), rng.unit());
    let centers: Vec<_> = (0..50).map(|_| point()).collect();
    let small = |p: Vec3, c: Vec3, size: f32| around(c + (p - 0.5) * size, 1e-3 * size);
    let boxes: Vec<_> = (0..N)
        .map(|i| small(point(), centers[i % 50], if i % 3 == 0 { 0.5 } else { 0.05 }))
        .collect();
    let [fast, default, high] =
        QUALITIES.map(|q| cost(&build(primitives(&boxes), &Anything(4), q)));
    assert!(default < fast * 0.999 && high < default * 0.99, "{fast} {default} {high}");
}
