//! The bill of a render as tables for a terminal: what the stages took, and what the classes of transport brought.

use crate::ledger::{Class, Stage};
use crate::render::Rendered;

/// Both tables.
pub(super) fn lines(rendered: &Rendered) -> Vec<String> {
    let ledger = &rendered.ledger;
    let whole = ledger.worker_seconds.max(1e-9);
    let share = |seconds: f64| 100.0 * seconds / whole;
    let mut lines = vec![format!(
        "{:16}{:>9} {:>6} {:>10} {:>12} {:>8} {:>7}",
        "stage", "seconds", "time", "calls", "rays", "ns/ray", "batch"
    )];
    for &stage in Stage::ALL {
        let totals = ledger.stage(stage);
        if totals.calls > 0 {
            let per_ray = 1e9 * totals.seconds / totals.items.max(1) as f64;
            let batch = totals.items as f64 / totals.calls as f64;
            lines.push(format!(
                "  {:14}{:9.2} {:4.1} % {:10} {:12} {per_ray:8.1} {batch:7.0}",
                stage.name(),
                totals.seconds,
                share(totals.seconds),
                totals.calls,
                totals.items
            ));
        }
    }
    if ledger.cut_outs.calls > 0 {
        lines.push(format!(
            "  {:14}{:9.2} {:4.1} % {:10}   within intersect and shadow",
            "cut-outs",
            ledger.cut_outs.seconds,
            share(ledger.cut_outs.seconds),
            ledger.cut_outs.calls
        ));
    }
    let (pixels, shares) = rendered.classes.shares(&rendered.film);
    lines.push(format!(
        "{:22}{:>12} {:>6} {:>7} {:>7}   (light and noise: {pixels} pixels)",
        "light", "rays", "time", "light", "noise"
    ));
    for &class in Class::ALL {
        let rays = ledger.class_rays(class);
        let found = shares.iter().find(|share| share.class == class);
        if rays.path + rays.shadow > 0 || found.is_some() {
            let (energy, variance) = found.map_or((0.0, 0.0), |s| (s.energy, s.variance));
            lines.push(format!(
                "  {:20}{:12} {:4.1} % {:5.1} % {:5.1} %",
                class.name(),
                rays.path + rays.shadow,
                share(ledger.class_seconds(class)),
                100.0 * energy,
                100.0 * variance
            ));
        }
    }
    lines
}
