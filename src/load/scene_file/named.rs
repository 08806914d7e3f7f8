//! `[KIND.NAME]`: tables with names that the user chose, in the order of the file.

use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};
use std::collections::HashMap;
use std::fmt;
use std::marker::PhantomData;
use toml::Spanned;

/// Named entries in the order of the file. (TOML itself rejects a name that is given twice.)
#[derive(Debug)]
pub(super) struct Named<T> {
    entries: Vec<(Spanned<String>, T)>,
    index: HashMap<String, usize>,
}

impl<T> Default for Named<T> {
    fn default() -> Self {
        Self { entries: Vec::new(), index: HashMap::new() }
    }
}

impl<T> Named<T> {
    /// Names and entries, in the order of the file.
    pub(super) fn iter(&self) -> impl Iterator<Item = &(Spanned<String>, T)> {
        self.entries.iter()
    }

    /// The names, in the order of the file.
    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        self.entries.iter().map(|entry| entry.0.get_ref().as_str())
    }

    /// The entry called `name`.
    pub(super) fn get(&self, name: &str) -> Option<&T> {
        self.index.get(name).map(|&index| &self.entries[index].1)
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Named<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NamedVisitor<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for NamedVisitor<T> {
            type Value = Named<T>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("named entries")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
                let mut entries: Vec<(Spanned<String>, T)> = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    entries.push(entry);
                }
                // The parser hands tables over in alphabetical order.
                entries.sort_by_key(|entry| entry.0.span().start);
                let names = entries.iter().map(|entry| entry.0.get_ref().clone());
                let index = names.enumerate().map(|(index, name)| (name, index)).collect();
                Ok(Named { entries, index })
            }
        }
        deserializer.deserialize_map(NamedVisitor(PhantomData))
    }
}
