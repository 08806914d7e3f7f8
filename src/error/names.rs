//! What to say about a name that does not exist: which names there are, and which of them may be meant.

/// That `name` is not among `known`, and which of them may be meant; `what` is its kind ("material").
pub fn unknown_name<'n>(
    what: &str,
    name: &str,
    known: impl IntoIterator<Item = &'n str>,
) -> String {
    let known: Vec<&str> = known.into_iter().collect();
    format!("unknown {what} `{name}`{}", advice(name, &known, "Known"))
}

/// What to write instead of `name`: the likeliest of `known` and the list of them all.
pub(crate) fn advice(name: &str, known: &[&str], lead: &str) -> String {
    let suggestion = did_you_mean(name, known.iter().copied())
        .map_or(".".to_owned(), |known| format!("; did you mean `{known}`?"));
    let list = if known.is_empty() { "none".to_owned() } else { quoted(known) };
    format!("{suggestion} {lead}: {list}")
}

/// The names between backticks and commas; the first thirty of them.
pub(crate) fn quoted(names: &[&str]) -> String {
    const SHOWN: usize = 30;
    let shown: Vec<String> = names.iter().take(SHOWN).map(|name| format!("`{name}`")).collect();
    let rest = names.len().saturating_sub(SHOWN);
    let more = if rest > 0 { format!(" and {rest} more") } else { String::new() };
    shown.join(", ") + &more
}

/// The name among `known` that `name` is likeliest to be a misspelling or a part of, if any is likely:
/// at most a third of its letters are wrong, or one contains the other.
fn did_you_mean<'n>(name: &str, known: impl IntoIterator<Item = &'n str>) -> Option<&'n str> {
    let name = name.to_lowercase();
    let cost = |candidate: &str| {
        let candidate = candidate.to_lowercase();
        let distance = strsim::damerau_levenshtein(&name, &candidate);
        let part = name.len().min(candidate.len()) >= 3
            && (candidate.contains(&name) || name.contains(&candidate));
        let close = distance <= (name.chars().count() / 3).max(1);
        (close || part).then_some(if close { distance } else { 100 + distance })
    };
    known
        .into_iter()
        .filter_map(|candidate| Some((cost(candidate)?, candidate)))
        .min()
        .map(|best| best.1)
}

/// Declares a closed set whose members have names: the enum, `ALL` in the order of declaration, and `name`.
macro_rules! named_set {
    ($(#[$attribute:meta])* $set:ident { $($(#[doc = $doc:literal])* $member:ident = $name:literal,)* }) => {
        $(#[$attribute])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum $set {
            $($(#[doc = $doc])* $member,)*
        }

        impl $set {
            /// Every member, in the order of tables.
            pub const ALL: &'static [Self] = &[$(Self::$member,)*];

            /// Its name for users, in tables and in JSON.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$member => $name,)*
                }
            }
        }
    };
}
pub(crate) use named_set;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn suggestions_are_likely_ones_only() {
        let known = ["vertical_fov", "lens_radius", "focus_distance"];
        assert_eq!(did_you_mean("lens_radios", known), Some("lens_radius"));
        assert_eq!(did_you_mean("FOV", known), Some("vertical_fov"));
        assert_eq!(did_you_mean("focus_dist", known), Some("focus_distance"));
        assert_eq!(did_you_mean("banana", known), None);
        assert_eq!(did_you_mean("x", ["y"]), Some("y"));
    }
}
