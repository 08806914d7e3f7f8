//! The bill of a render as tables for a terminal: what the stages took, and what the classes of transport brought.

use crate::render::Bill;

/// Both tables.
pub(super) fn lines(bill: &Bill) -> Vec<String> {
    let mut lines = vec![format!(
        "{:16}{:>9} {:>6} {:>10} {:>12} {:>8} {:>7}",
        "stage", "seconds", "time", "calls", "rays", "ns/ray", "batch"
    )];
    for row in bill.ran() {
        lines.push(format!(
            "  {:14}{:9.2} {:4.1} % {:10} {:12} {:>8} {:7.0}",
            row.stage,
            row.seconds,
            100.0 * row.time_share,
            row.calls,
            row.rays,
            row.nanoseconds_per_ray().map_or("-".into(), |ns| format!("{ns:.1}")),
            row.mean_batch
        ));
    }
    let rest = bill.worker_seconds - bill.ran().map(|row| row.seconds).sum::<f64>();
    lines.push(format!(
        "  {:14}{rest:9.2} {:4.1} %",
        "elsewhere",
        100.0 * rest / bill.worker_seconds.max(1e-9)
    ));
    let cut_outs = &bill.cut_outs;
    if cut_outs.calls > 0 {
        lines.push(format!(
            "  {:14}{:9.2} {:4.1} % {:10}   within intersect and shadow",
            "cut-outs",
            cut_outs.seconds,
            100.0 * cut_outs.time_share,
            cut_outs.calls
        ));
    }
    lines.push(format!(
        "{:22}{:>12} {:>6} {:>7} {:>7}   (light and noise: {} pixels)",
        "light", "rays", "time", "light", "noise", bill.watched_pixels
    ));
    for row in &bill.classes {
        let noise =
            row.variance_share.map_or("-".into(), |share| format!("{:.1} %", 100.0 * share));
        lines.push(format!(
            "  {:20}{:12} {:4.1} % {:5.1} % {noise:>7}",
            row.class,
            row.rays,
            100.0 * row.time_share,
            100.0 * row.energy_share
        ));
    }
    if bill.classes.iter().any(|row| row.variance_share.is_some_and(|share| share < -5e-4)) {
        lines.push("  (less noise than none: it cancels that of others)".into());
    }
    lines
}
