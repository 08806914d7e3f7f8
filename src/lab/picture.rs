//! A set as a picture without words: its points, and beside them its periodogram.

use super::exhibit::Exhibit;

/// Pixels along each of the two squares, and between and around them.
const SIDE: u32 = 512;
const GAP: u32 = 16;

/// Row-major, top row first, with columns and rows; y is upwards.
pub fn of(exhibit: &Exhibit) -> (Vec<[u8; 1]>, [u32; 2]) {
    let size = [3 * GAP + 2 * SIDE, 2 * GAP + SIDE];
    let mut canvas = Canvas { size, shades: vec![1.0; (size[0] * size[1]) as usize] };
    let radius =
        (0.22 * f64::from(SIDE) / (exhibit.points.len().max(1) as f64).sqrt()).clamp(0.7, 5.0);
    for [x, y] in &exhibit.points {
        let side = f64::from(SIDE);
        canvas.disc([f64::from(GAP) + side * x, f64::from(GAP) + side * (1.0 - y)], radius);
    }
    let limit = exhibit.spectrum.limit() as i64;
    let width = (2 * limit + 1) as u32;
    for row in 0..SIDE {
        for column in 0..SIDE {
            let [kx, ky] = [column, SIDE - 1 - row].map(|i| i64::from(i * width / SIDE) - limit);
            // The origin has the power n of every set: nothing to see.
            let power =
                if (kx, ky) == (0, 0) { 0.0 } else { exhibit.spectrum.at(kx, ky).unwrap_or(0.0) };
            // Four times the power of random points is black.
            canvas.darken([2 * GAP + SIDE + column, GAP + row], (power / 4.0).sqrt().min(1.0));
        }
    }
    for left in [GAP, 2 * GAP + SIDE] {
        canvas.frame(left, GAP);
    }
    let bytes = canvas.shades.iter().map(|shade| [(255.0 * shade + 0.5) as u8]);
    (bytes.collect(), size)
}

/// Shades from 0, black, to 1, white.
struct Canvas {
    size: [u32; 2],
    shades: Vec<f64>,
}

impl Canvas {
    /// Covers a part of a pixel with black; nothing outside of the picture.
    fn darken(&mut self, [column, row]: [u32; 2], part: f64) {
        if column < self.size[0] && row < self.size[1] {
            self.shades[(row * self.size[0] + column) as usize] *= 1.0 - part;
        }
    }

    /// A disc, its edge as wide as a pixel.
    fn disc(&mut self, [x, y]: [f64; 2], radius: f64) {
        let range = |c: f64| (c - radius - 1.0).max(0.0) as u32..=(c + radius + 1.0) as u32;
        for row in range(y) {
            for column in range(x) {
                let [dx, dy] = [f64::from(column) + 0.5 - x, f64::from(row) + 0.5 - y];
                let inside = radius + 0.5 - (dx * dx + dy * dy).sqrt();
                self.darken([column, row], inside.clamp(0.0, 1.0));
            }
        }
    }

    /// A thin line around one of the squares.
    fn frame(&mut self, left: u32, top: u32) {
        for i in 0..=SIDE {
            for at in [[i, 0], [i, SIDE], [0, i], [SIDE, i]] {
                self.darken([left + at[0] - 1, top + at[1] - 1], 0.4);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::Strategy;

    /// The ink on the left is that of the discs; a grid's periodogram has nothing but its peaks.
    #[test]
    fn there_is_as_much_ink_as_there_are_points() {
        let exhibit = Exhibit::of_strategy(Strategy::Grid, 64, 0).unwrap();
        let (pixels, [width, height]) = of(&exhibit);
        assert_eq!(pixels.len(), (width * height) as usize);
        let ink = |columns: std::ops::Range<u32>| -> f64 {
            let inside =
                (GAP..GAP + SIDE - 1).flat_map(|row| columns.clone().map(move |c| row * width + c));
            inside.map(|i| 1.0 - f64::from(pixels[i as usize][0]) / 255.0).sum()
        };
        let radius = 5.0_f64;
        let discs = 64.0 * std::f64::consts::PI * radius * radius;
        let left = ink(GAP..GAP + SIDE - 1);
        assert!((left / discs - 1.0).abs() < 0.05, "{left} {discs}");
        // Frequencies up to twice 8: eight peaks, whole squares of pixels; the origin is left out.
        let peak = (f64::from(SIDE) / 33.0).powi(2);
        let right = ink(2 * GAP + SIDE..2 * GAP + 2 * SIDE - 1);
        assert!(right > 15.0 * peak && right < 26.0 * peak, "{}", right / peak);
    }
}
