//! The findings of whole frames as a table for a terminal, at most 100 columns wide.

use super::table::{busy, scene, threads, times};
use crate::study::bench::{DifferingPixels, Frame, FrameFindings};

/// Columns of names.
const NAMES: usize = 40;

/// Pixels that are shown; the JSON has all.
const SHOWN: usize = 20;

/// Everything about the frames of a scene.
pub(super) fn findings(findings: &FrameFindings) -> String {
    let mut lines = scene(&findings.scene);
    for (i, frame) in findings.frames.iter().enumerate() {
        let before = i.checked_sub(1).map(|i| &findings.frames[i]);
        if before.is_none_or(|before| before.threads != frame.threads) {
            lines.push(String::new());
            lines.push(heading(findings, frame));
        }
        lines.push(row(findings, frame));
    }
    busy(findings.frames.iter().map(|frame| frame.busy_turns).sum(), &mut lines);
    for pixels in &findings.differing_pixels {
        lines.push(String::new());
        differing(pixels, &mut lines);
    }
    if !findings.ratios.is_empty() {
        lines.push(String::new());
        lines.push(
            "Seconds from the first path to the last; structures are built before.\n\
             ~: a tie; the 95 % interval of the median of the repetitions' ratios holds 1."
                .into(),
        );
    }
    lines.join("\n")
}

fn heading(findings: &FrameFindings, frame: &Frame) -> String {
    let ([width, height], spp) = (frame.size, frame.samples_per_pixel);
    let title = format!("{width}x{height}, {spp} spp; {}", threads(frame.threads));
    let ratio = findings.ratios.first().map_or(String::new(), |ratio| format!("/ {}", ratio.rival));
    let heading =
        format!("{title:NAMES$} {:>26} {:>9} {ratio:>9}", "seconds (min-max)", "M rays/s");
    heading.trim_end().to_owned()
}

fn row(findings: &FrameFindings, frame: &Frame) -> String {
    let name = format!("  {} {} {}", frame.backend, frame.isa, frame.variant);
    let (Some(seconds), Some(speed)) = (frame.seconds, frame.rays_per_second) else {
        return format!("{name:NAMES$} WRONG: {} frames unlike the first", frame.unsteady_turns);
    };
    let range = format!("{:.3} ({:.3}-{:.3})", seconds.median, seconds.min, seconds.max);
    let key = (frame.backend, frame.threads);
    let ratio = findings.ratios.iter().find(|ratio| (ratio.backend, ratio.threads) == key);
    let ratio = ratio.map_or(String::new(), |ratio| times(&ratio.ratio));
    format!("{name:NAMES$} {range:>26} {:>9.2} {ratio:>9}", speed / 1e6).trim_end().to_owned()
}

/// How many pixels differ, the first of them, and what to think of it.
fn differing(pixels: &DifferingPixels, lines: &mut Vec<String>) {
    let DifferingPixels { backend, rival, count, all, .. } = *pixels;
    let share = 100.0 * count as f64 / all.max(1) as f64;
    lines.push(format!(
        "pixels that differ between {rival} and {backend}: {count} of {all} ({share:.4} %)"
    ));
    let shown: Vec<_> = pixels.pixels.iter().take(SHOWN).map(|[x, y]| format!("{x},{y}")).collect();
    lines.extend(shown.chunks(8).map(|some| format!("  {}", some.join("  "))));
    if count > shown.len() {
        lines.push(format!("  and {} more (--json lists all)", count - shown.len()));
    }
    if pixels.is_too_many() {
        lines.push(format!(
            "MANY: more than {} %. Are there surfaces in the same place, so that each backend sees another one,\n\
             or thin things everywhere and many samples? If not, one of the two misses something.",
            // Two decimals, and no zeros behind.
            (1e4 * pixels.most()).round() / 100.0
        ));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines_of(count: u32, all: usize) -> Vec<String> {
        let mut lines = Vec::new();
        let pixels = DifferingPixels {
            scene: "a.obj".into(),
            backend: "bvh",
            rival: "embree",
            count: count as usize,
            all,
            samples_per_pixel: 16,
            pixels: (0..count).map(|x| [x, 7]).collect(),
        };
        differing(&pixels, &mut lines);
        lines
    }

    #[test]
    fn twenty_pixels_are_shown_and_the_rest_is_counted() {
        assert_eq!(lines_of(0, 100).len(), 1);
        let some = lines_of(20, 100_000);
        assert_eq!(some.last().unwrap(), "  16,7  17,7  18,7  19,7");
        let many = lines_of(33, 100_000);
        assert_eq!(many[..4].len() + 1, many.len());
        assert_eq!(many.last().unwrap(), "  and 13 more (--json lists all)");
        assert!(many[0].ends_with("33 of 100000 (0.0330 %)"), "{}", many[0]);
    }

    #[test]
    fn too_many_are_pointed_out() {
        assert!(!lines_of(2, 1000).concat().contains("MANY: more than 0.2 %"));
        assert!(lines_of(3, 1000).concat().contains("MANY: more than 0.2 %"));
    }
}
