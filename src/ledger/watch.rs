//! The pixels whose light is told apart by transport class: one in each cell of a grid, drawn by a hash, so that the
//! bill for all of the image costs next to nothing. In small images that is every pixel.

/// Which pixels of an image are watched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Watch {
    /// Edge of a cell in pixels; 0 where no pixel is watched.
    edge: u32,
    /// Cells a row.
    columns: u32,
    /// Left and top of the first cell.
    start: [u32; 2],
}

impl Watch {
    /// No pixel.
    pub const NONE: Self = Self { edge: 0, columns: 0, start: [0; 2] };

    /// At most `limit` pixels (at least 1) of the rectangle from `start` to `end`, as evenly as can be.
    pub fn new(start: [u32; 2], end: [u32; 2], limit: u64) -> Self {
        let [width, height] = [0, 1].map(|k| end[k].saturating_sub(start[k]));
        let cells = |edge: u32| {
            let [columns, rows] = [width, height].map(|n| u64::from(n.div_ceil(edge)));
            columns * rows
        };
        let mut edge = 1;
        while cells(edge) > limit.max(1) {
            edge += 1;
        }
        Self { edge, columns: width.div_ceil(edge), start }
    }

    /// Number of cells of an image `height` pixels high.
    pub fn cells(&self, height: u32) -> usize {
        match self.edge {
            0 => 0,
            edge => self.columns as usize * height.div_ceil(edge) as usize,
        }
    }

    /// The number of the cell whose pixel `pixel` is, if it is one's. A cell that the image cuts off may have none.
    #[inline]
    pub fn cell(&self, pixel: [u32; 2]) -> Option<u32> {
        if self.edge == 0 {
            return None;
        }
        let [x, y] = [0, 1].map(|k| pixel[k] - self.start[k]);
        let (column, row) = (x / self.edge, y / self.edge);
        let cell = row * self.columns + column;
        // A random place in the cell: a regular one could miss what is regular in the picture.
        let place = mix(cell) % (self.edge * self.edge);
        let is_it = [x % self.edge, y % self.edge] == [place % self.edge, place / self.edge];
        is_it.then_some(cell)
    }
}

/// A hash of 32 bits (C. Wellons' "lowbias32", found by search in 2018).
const fn mix(mut x: u32) -> u32 {
    x ^= x >> 16;
    x = x.wrapping_mul(0x7feb_352d);
    x ^= x >> 15;
    x = x.wrapping_mul(0x846c_a68b);
    x ^ x >> 16
}

#[cfg(test)]
mod tests {
    use super::*;

    fn watched(watch: &Watch, start: [u32; 2], end: [u32; 2]) -> Vec<u32> {
        let rows = start[1]..end[1];
        rows.flat_map(|y| (start[0]..end[0]).filter_map(move |x| watch.cell([x, y]))).collect()
    }

    #[test]
    fn small_images_are_watched_whole_and_large_ones_evenly() {
        let (start, end) = ([3, 5], [43, 35]);
        let whole = Watch::new(start, end, 1200);
        assert_eq!(watched(&whole, start, end), (0..1200).collect::<Vec<_>>());
        assert_eq!(whole.cells(30), 1200);
        let few = Watch::new(start, end, 100);
        let cells = watched(&few, start, end);
        // 40 x 30 pixels in cells of 4: none is cut off on the right, half a row of cells below may be empty.
        assert!(cells.len() <= 100 && cells.len() >= 70, "{}", cells.len());
        assert!(cells.iter().all(|&cell| (cell as usize) < few.cells(30)));
        let mut once = cells.clone();
        once.sort_unstable();
        once.dedup();
        assert_eq!(once.len(), cells.len());
        assert!(watched(&Watch::NONE, start, end).is_empty());
    }
}
