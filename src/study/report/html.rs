//! HTML under construction: markup is constant, everything else is escaped.

use std::fmt::Display;

/// A page so far.
#[derive(Default)]
pub(super) struct Html {
    text: String,
}

/// What every page looks like.
const STYLE: &str = "
:root { color-scheme: light dark; --ink: light-dark(#1b1f24, #e6e8ea); --soft: light-dark(#5c6670, #9aa4ae);
  --line: light-dark(#d5dade, #3a424a); --paper: light-dark(#ffffff, #15191d); }
body { font: 15px/1.45 system-ui, sans-serif; color: var(--ink); background: var(--paper);
  max-width: 76rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.5rem; } h2 { margin-top: 3rem; border-bottom: 2px solid var(--line); overflow-wrap: anywhere; }
h3 { margin: 2rem 0 .3rem; font-size: 1.05rem; } p { margin: .3rem 0; } .soft { color: var(--soft); }
table { border-collapse: collapse; margin: .6rem 0; font-variant-numeric: tabular-nums; }
th, td { padding: .2rem .8rem .2rem 0; text-align: right; border-bottom: 1px solid var(--line); }
th:first-child, td:first-child { text-align: left; } th { font-weight: 600; vertical-align: bottom; }
code { overflow-wrap: anywhere; } .better { color: light-dark(#0a7a3f, #5fd494); } .wrong { color: light-dark(#b3261e, #ff8a80); }
.charts { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(34rem, 100%), 1fr)); gap: 0 2rem; }
svg { width: 100%; height: auto; font: 12px system-ui, sans-serif; } svg text { fill: var(--ink); }
svg .soft { fill: var(--soft); } svg .whisker { stroke: var(--ink); stroke-width: 1.2; }
.words th, .words td { text-align: left; vertical-align: top; } .legend span { display: inline-block; width: .8em; height: .8em;
  margin: 0 .3em 0 .9em; } svg .in { fill: #111; }
svg .embree { fill: light-dark(#9db8d8, #4d6c92); } svg .bvh { fill: light-dark(#e2963b, #d98a2b); }
";

impl Html {
    /// The beginning of a page, up to its body.
    pub(super) fn page(title: &'static str) -> Self {
        let mut page = Self::default();
        page.markup("<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\">")
            .markup("<meta name=\"viewport\" content=\"width=device-width\">\n")
            .element("title", &[], title)
            .element_of_markup("style", STYLE)
            .markup("</head>\n<body>\n")
            .element("h1", &[], title);
        page
    }

    /// The whole page.
    pub(super) fn finish(mut self) -> String {
        self.markup("</body>\n</html>\n");
        self.text
    }

    /// What there is, as a part of something else or a file of another kind.
    pub(super) fn into_text(self) -> String {
        self.text
    }

    /// Constant markup, as it is.
    pub(super) fn markup(&mut self, markup: &'static str) -> &mut Self {
        self.text += markup;
        self
    }

    /// Text, escaped.
    pub(super) fn text(&mut self, text: impl Display) -> &mut Self {
        for c in text.to_string().chars() {
            match c {
                '&' => self.text += "&amp;",
                '<' => self.text += "&lt;",
                '>' => self.text += "&gt;",
                '"' => self.text += "&quot;",
                '\'' => self.text += "&#39;",
                _ => self.text.push(c),
            }
        }
        self
    }

    /// The beginning of an element, values of attributes escaped.
    pub(super) fn open(
        &mut self,
        name: &'static str,
        attributes: &[(&'static str, &dyn Display)],
    ) -> &mut Self {
        self.markup("<").markup(name);
        for (attribute, value) in attributes {
            self.markup(" ").markup(attribute).markup("=\"").text(value).markup("\"");
        }
        self.markup(">")
    }

    /// The end of an element.
    pub(super) fn close(&mut self, name: &'static str) -> &mut Self {
        self.markup("</").markup(name).markup(">\n")
    }

    /// An element with nothing but text in it.
    pub(super) fn element(
        &mut self,
        name: &'static str,
        attributes: &[(&'static str, &dyn Display)],
        text: impl Display,
    ) -> &mut Self {
        self.open(name, attributes).text(text).close(name)
    }

    fn element_of_markup(&mut self, name: &'static str, markup: &'static str) -> &mut Self {
        self.open(name, &[]).markup(markup).close(name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_comes_from_outside_is_escaped() {
        let mut html = Html::default();
        html.element("p", &[("title", &"\"><script>")], "a<b & 'c'");
        let expected = "<p title=\"&quot;&gt;&lt;script&gt;\">a&lt;b &amp; &#39;c&#39;</p>\n";
        assert_eq!(html.text, expected);
    }

    #[test]
    fn a_page_is_whole() {
        let page = Html::page("Title").finish();
        assert!(page.starts_with("<!DOCTYPE html>") && page.ends_with("</html>\n"));
        assert_eq!(page.matches('<').count(), page.matches('>').count());
    }
}
