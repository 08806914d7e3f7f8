//! A drawing as SVG text: one circle a dot, in pixels of the picture. Source: W3C, SVG 1.1, sections 7.7 and
//! 9.3.

use super::Drawing;
use std::io::{self, Write};

impl Drawing {
    /// Writes the SVG document. Coordinates have two decimals, radii three.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write_svg(&self, out: &mut impl Write) -> io::Result<()> {
        let [width, height] = self.size;
        let (paper, ink) = if self.inverted { ("#000", "#fff") } else { ("#fff", "#000") };
        writeln!(
            out,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\">\n\
             <rect width=\"{width}\" height=\"{height}\" fill=\"{paper}\"/>\n<g fill=\"{ink}\">"
        )?;
        for dot in &self.dots {
            let ([x, y], r) = (dot.centre, dot.radius);
            writeln!(out, "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{r:.3}\"/>")?;
        }
        writeln!(out, "</g>\n</svg>")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::stipple::Dot;

    #[test]
    fn the_document_is_as_written_here() {
        let dot = |x, y, radius| Dot { centre: [x, y], radius };
        let dots = vec![dot(0.0, 2.996, 0.25), dot(12.344, 7.0, 1.0 / 3.0)];
        for (inverted, paper, ink) in [(false, "#fff", "#000"), (true, "#000", "#fff")] {
            let mut text = Vec::new();
            let drawing = Drawing { size: [30, 20], dots: dots.clone(), inverted };
            drawing.write_svg(&mut text).unwrap();
            let expected = format!(
                "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"30\" height=\"20\" \
                 viewBox=\"0 0 30 20\">\n<rect width=\"30\" height=\"20\" fill=\"{paper}\"/>\n<g fill=\"{ink}\">\n\
                 <circle cx=\"0.00\" cy=\"3.00\" r=\"0.250\"/>\n\
                 <circle cx=\"12.34\" cy=\"7.00\" r=\"0.333\"/>\n</g>\n</svg>\n"
            );
            assert_eq!(String::from_utf8(text).unwrap(), expected);
        }
    }
}
