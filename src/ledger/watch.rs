//! The pixels whose light is told apart by transport class: one in each cell of a grid, drawn by a hash, so that the
//! bill for all of the image costs next to nothing. In small images that is every pixel.

/// Which pixels of an image are watched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Watch {
    /// A cell is 2^`size_log2` pixels wide and high: pixels are found by shifts, for every path.
    size_log2: [u32; 2],
    /// Cells a row; 0 where no pixel is watched.
    columns: u32,
    /// Left and top of the first cell.
    start: [u32; 2],
}

impl Watch {
    /// No pixel.
    pub const NONE: Self = Self { size_log2: [0; 2], columns: 0, start: [0; 2] };

    /// At most `limit` pixels (at least 1) of the rectangle from `start` to `end`, as evenly as can be.
    pub fn new(start: [u32; 2], end: [u32; 2], limit: u64) -> Self {
        let [width, height] = [0, 1].map(|k| end[k].saturating_sub(start[k]));
        let count = |size_log2: [u32; 2]| {
            [width.div_ceil(1 << size_log2[0]), height.div_ceil(1 << size_log2[1])]
        };
        let mut size_log2 = [0; 2];
        loop {
            let [columns, rows] = count(size_log2);
            if u64::from(columns) * u64::from(rows) <= limit.max(1) {
                return Self { size_log2, columns, start };
            }
            // Cells grow along their shorter edge, unless there is no second one to join.
            let is_flat = size_log2[1] < size_log2[0];
            let axis = if columns == 1 || is_flat && rows > 1 { 1 } else { 0 };
            size_log2[axis] += 1;
        }
    }

    /// Number of cells of an image `height` pixels high.
    pub fn cells(&self, height: u32) -> usize {
        self.columns as usize * height.div_ceil(1 << self.size_log2[1]) as usize
    }

    /// The number of the cell whose pixel `pixel` is, if it is one's. A cell that the image cuts off may have none.
    #[inline]
    pub fn cell(&self, pixel: [u32; 2]) -> Option<u32> {
        let [x, y] = [0, 1].map(|k| pixel[k] - self.start[k]);
        let [wide, high] = self.size_log2;
        let cell = (y >> high) * self.columns + (x >> wide);
        // A random place in the cell: a regular one could miss what is regular in the picture.
        let place = mix(cell);
        let is_at = |n: u32, log2: u32, place: u32| (n ^ place) & ((1 << log2) - 1) == 0;
        (self.columns > 0 && is_at(x, wide, place) && is_at(y, high, place >> 16)).then_some(cell)
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
        assert!(cells.len() <= 80 && cells.len() >= 70, "{}", cells.len());
        let narrow = Watch::new([0, 0], [1, 65536], 4096);
        assert_eq!(watched(&narrow, [0, 0], [1, 65536]).len(), 4096);
        assert!(cells.iter().all(|&cell| (cell as usize) < few.cells(30)));
        let mut once = cells.clone();
        once.sort_unstable();
        once.dedup();
        assert_eq!(once.len(), cells.len());
        assert!(watched(&Watch::NONE, start, end).is_empty());
    }
}
