//! How a picture was made, as text that travels in its file.

use crate::render::Frame;
use snell_components::{
    color::Encoding,
    describe::{Describe, FieldVisitor, Spec, Value},
    settings::Settings,
    transform::Step,
};
use std::{collections::BTreeMap, path::Path};

/// Keys of [`Metadata`].
pub mod key {
    /// Name and version of the program.
    pub const SOFTWARE: &str = "Software";
    /// The scene file as the user gave it.
    pub const SCENE: &str = "snell:scene";
    /// All settings of the scene with what the command line changed, as a scene file would have them.
    pub const SETTINGS: &str = "snell:settings";
    /// The methods by which rays found what they met; absent if those are the default ones.
    pub const METHODS: &str = "snell:methods";
    /// What the levels of a PNG mean, a word of [`super::Encoding`]; absent for sRGB.
    pub const ENCODING: &str = "snell:encoding";
    /// The region drawn, as `x,y,width,height`; absent if that is the whole picture.
    pub const REGION: &str = "snell:region";
    /// Pixels drawn and pixels asked for, as `drawn/asked`; absent if all were drawn.
    pub const DRAWN: &str = "snell:drawn";
    /// What the time that was given allowed for, in words; absent unless a time was given.
    pub const TIME: &str = "snell:time";
    /// The counts of the render, as JSON.
    pub const COUNTS: &str = "snell:counts";
    /// SHA-256 of the picture in linear light, see [`crate::render::Picture::hash`].
    pub const HASH: &str = "snell:hash";
}

/// Text by key, a line each.
///
/// It holds nothing that does not follow from the scene and the options: no date, no machine, no number of threads. So
/// the file of a picture is the same to the last bit wherever and whenever it is made, unless it was made for a time.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Metadata(BTreeMap<String, String>);

impl Metadata {
    /// Name and version of this program.
    pub const SOFTWARE: &str = concat!("Snell ", env!("CARGO_PKG_VERSION"));

    /// All that there is to say of a frame.
    #[must_use]
    pub fn of(frame: &Frame, settings: &Settings, scene: &Path) -> Self {
        let mut this = Self::default();
        this.insert(key::SOFTWARE, Self::SOFTWARE);
        this.insert(key::SCENE, scene.to_string_lossy());
        this.insert(key::SETTINGS, settings_text(settings));
        if settings.encoding != Encoding::default() {
            this.insert(key::ENCODING, format!("{:?}", settings.encoding));
        }
        let region = frame.region;
        if region != crate::render::Region::whole(settings.width, settings.height) {
            this.insert(key::REGION, format!("{},{},{},{}", region.x, region.y, region.width, region.height));
        }
        if !frame.is_complete() {
            this.insert(key::DRAWN, format!("{}/{}", frame.done, region.area()));
        }
        // Counts are plain numbers under plain names, which JSON always holds.
        this.insert(key::COUNTS, serde_json::to_string(&frame.counts).unwrap_or_default());
        this.insert(key::HASH, frame.picture.hash());
        this
    }

    /// Puts a value under a key, in place of what was there; control characters such as line breaks become spaces.
    pub fn insert(&mut self, key: &str, value: impl AsRef<str>) {
        self.0.insert(key.into(), value.as_ref().replace(char::is_control, " "));
    }

    /// What the levels of a PNG mean.
    #[must_use]
    pub fn encoding(&self) -> Encoding {
        if self.get(key::ENCODING) == Some("Raw") { Encoding::Raw } else { Encoding::Srgb }
    }

    /// The value of a key.
    #[must_use]
    pub fn get(&self, key: &str) -> Option<&str> {
        self.0.get(key).map(String::as_str)
    }

    /// Keys and values, in the order of keys.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &str)> {
        self.0.iter().map(|(key, value)| (key.as_str(), value.as_str()))
    }
}

/// Settings as a scene file has them.
fn settings_text(settings: &Settings) -> String {
    struct Fields(Vec<String>);
    impl FieldVisitor for Fields {
        fn field(&mut self, name: &'static str, value: Value<'_>, _: Spec) {
            let value = match value {
                Value::Number(x) => format!("{x:?}"),
                Value::Integer(n) => n.to_string(),
                Value::Bool(yes) => yes.to_string(),
                Value::Color(c) => format!("({:?}, {:?}, {:?})", c.x, c.y, c.z),
                Value::Choice(choice) => format!("{choice:?}"),
                Value::Steps(steps) => {
                    format!("[{}]", steps.iter().map(Step::to_string).collect::<Vec<_>>().join(", "))
                }
                other => format!("{other:?}"),
            };
            self.0.push(format!("{name}: {value}"));
        }
    }
    let mut fields = Fields(vec![]);
    settings.clone().describe(&mut fields);
    format!("({})", fields.0.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::{Counts, Picture, Region};

    #[test]
    fn a_frame_is_told_in_full() {
        let settings = Settings { width: 4, height: 3, cutoff: 1e-7, ..Settings::default() };
        let region = Region { x: 1, y: 0, width: 2, height: 2 };
        let counts = Counts { primary: 7, ..Counts::default() };
        let frame = Frame { picture: Picture::black(2, 2), region, counts, done: 2 };
        let told = Metadata::of(&frame, &settings, Path::new("a/b.ron"));
        assert_eq!(told.get(key::SCENE), Some("a/b.ron"));
        assert_eq!(told.get(key::REGION), Some("1,0,2,2"));
        assert_eq!(told.get(key::DRAWN), Some("2/4"));
        assert_eq!(told.get(key::HASH), Some(frame.picture.hash().as_str()));
        assert!(told.get(key::COUNTS).is_some_and(|counts| counts.contains(r#""primary":7"#)));
        let settings = told.get(key::SETTINGS).unwrap_or_default();
        assert!(settings.starts_with("(width: 4, height: 3, depth: 8, antialias: Off, grid: 4, "), "{settings}");
        assert!(settings.contains("background: (0.0, 0.0, 0.0)") && settings.contains("cutoff: 1e-7"), "{settings}");
    }
}
