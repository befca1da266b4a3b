//! Names of components and fields as people say them.

use snell::{
    components::describe::{Range, Spec},
    systems::{
        registry::{Kind, Registry},
        scene::Thing,
    },
};

/// A tag or field in words: `PointLight` is "Point light", `field_of_view` "Field of view".
#[must_use]
pub(super) fn words(name: &str) -> String {
    let mut words = String::new();
    for (at, letter) in name.char_indices() {
        match letter {
            '_' => words.push(' '),
            _ if at == 0 => words.extend(letter.to_uppercase()),
            _ if letter.is_uppercase() => {
                words.push(' ');
                words.extend(letter.to_lowercase());
            }
            _ => words.push(letter),
        }
    }
    words
}

/// The groups of the list of things.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Group {
    /// What is seen.
    Objects,
    /// What shines.
    Lights,
    /// What objects are made of.
    Materials,
    /// Where the picture is taken from.
    Camera,
    /// What only places others.
    Groups,
}

impl Group {
    /// All of them, as they are listed.
    pub(super) const ALL: [Self; 5] = [Self::Objects, Self::Lights, Self::Materials, Self::Camera, Self::Groups];

    /// The group of a thing.
    #[must_use]
    pub(super) fn of(thing: &Thing, registry: &Registry) -> Self {
        let kinds = thing.components.keys().filter_map(|tag| registry.get(tag)).map(|entry| entry.kind);
        let group = |kind| match kind {
            Kind::Shape => Self::Objects,
            Kind::Light => Self::Lights,
            Kind::Camera => Self::Camera,
            Kind::Effect | Kind::Texture | Kind::Filling => Self::Materials,
            Kind::Placement | Kind::Visibility => Self::Groups,
        };
        // A shape with effects is an object, a light that has a shape too.
        let order =
            |group: &Self| [Self::Objects, Self::Lights, Self::Camera, Self::Materials].iter().position(|g| g == group);
        kinds.map(group).min_by_key(|group| order(group).unwrap_or(usize::MAX)).unwrap_or(Self::Groups)
    }

    /// The heading.
    #[must_use]
    pub(super) fn heading(self) -> &'static str {
        match self {
            Self::Objects => "Objects",
            Self::Lights => "Lights",
            Self::Materials => "Materials",
            Self::Camera => "Camera",
            Self::Groups => "Groups",
        }
    }
}

/// The numbers that a field takes, to follow "a number" or "each".
#[must_use]
pub(super) fn limits(range: Range) -> String {
    let least = if range.min_inclusive { "at least" } else { "more than" };
    match (range.min > f64::MIN, range.max < f64::MAX) {
        (false, false) => String::new(),
        (true, false) => format!(" {least} {}", range.min),
        (false, true) => format!(" up to {}", range.max),
        (true, true) if range.min_inclusive => format!(" from {} to {}", range.min, range.max),
        (true, true) => format!(" more than {} and up to {}", range.min, range.max),
    }
}

/// What is said of a field when the pointer rests on it.
#[must_use]
pub(super) fn tip(spec: &Spec) -> String {
    let limits = limits(spec.range);
    if limits.is_empty() { spec.about.into() } else { format!("{}\nNumbers{limits}", spec.about) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tags_and_fields_become_words() {
        assert_eq!(words("PointLight"), "Point light");
        assert_eq!(words("field_of_view"), "Field of view");
        assert_eq!(words("Box"), "Box");
    }

    #[test]
    fn limits_are_said_in_words() {
        assert_eq!(limits(Spec::any("").range), "");
        assert_eq!(limits(Spec::positive("").range), " more than 0");
        assert_eq!(limits(Spec::within(0.0, 1.0, "").range), " from 0 to 1");
    }
}
