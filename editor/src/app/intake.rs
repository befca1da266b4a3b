//! Files that come in, by choice or dropped on the window, and pictures that go out.

use super::{add, command::Command, state::Editor};
use crate::session::Told;
use snell::{
    components::{
        asset::Asset,
        describe::{FieldVisitor, Spec, Value},
        shape::Mesh,
    },
    prelude::ImageTexture,
    systems::{
        registry::{AnyComponent, Kind},
        scene::Thing,
    },
};
use std::path::Path;

/// Images that can be textures.
pub(super) const IMAGES: &[&str] = &["png", "jpg", "jpeg", "bmp", "tga", "exr"];

fn asset<T>(file: &Path) -> Asset<T> {
    let file = std::path::absolute(file).unwrap_or(file.into());
    Asset { path: file.to_string_lossy().into_owned(), data: None }
}

impl Editor {
    /// Takes a file from outside: a scene is opened, a model added, an image put on the selected thing.
    pub(super) fn take(&mut self, file: &Path) {
        self.dialog = None;
        let extension = file.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase());
        match extension.as_deref() {
            Some("ron") => self.ask(Command::Open(file.into())),
            Some("obj") => {
                let stem = file.file_stem().map_or_else(|| "Model".into(), |stem| stem.to_string_lossy().into_owned());
                let name = self.session.document.free_name(&stem.replace('#', " "));
                let mesh = Mesh { model: asset(file), ..Mesh::default() };
                self.session.bring(format!("Add {}", name.as_str()), &name, Thing::default().with(mesh));
            }
            Some(extension) if IMAGES.contains(&extension) => {
                // On what the selected thing is made of, if that is shared.
                let shared = self.selected_thing().and_then(|(_, thing)| thing.made_of);
                let shared =
                    shared.and_then(|name| Some((name.clone(), (**self.session.document.get(&name)?).clone())));
                let Some((name, mut thing)) = shared.or_else(|| self.selected_thing()) else {
                    self.told = Some(Told::fault("Select the thing that the image is for, then drop it again", vec![]));
                    return;
                };
                let registry = self.session.document.registry();
                let is_texture = |tag: &str| registry.get(tag).is_some_and(|entry| entry.kind == Kind::Texture);
                thing.components.retain(|tag, _| !is_texture(tag));
                let texture = ImageTexture { image: asset(file), ..ImageTexture::default() };
                self.session.bring(format!("Image on {}", name.as_str()), &name, thing.with(texture));
            }
            _ => {
                let what = format!("{} is no scene, model or image that can be read", file.display());
                self.told = Some(Told::fault(what, vec![]));
            }
        }
    }

    pub(super) fn is_model(&self, tag: &str) -> bool {
        struct Finder(bool);
        impl FieldVisitor for Finder {
            fn field(&mut self, _: &'static str, value: Value<'_>, _: Spec) {
                self.0 |= matches!(value, Value::Model(_));
            }
        }
        let mut finder = Finder(false);
        if let Some(mut component) = add::fresh(tag, self.session.document.registry()) {
            component.visit(&mut finder);
        }
        finder.0
    }

    /// Names another file in a field of the selected thing's component, which is added if it is not there.
    pub(super) fn set_file(&mut self, tag: &'static str, field: &'static str, file: &Path) {
        struct Setter<'a>(&'static str, &'a Path);
        impl FieldVisitor for Setter<'_> {
            fn field(&mut self, name: &'static str, value: Value<'_>, _: Spec) {
                match value {
                    Value::Model(model) if name == self.0 => *model = asset(self.1),
                    Value::Image(image) if name == self.0 => *image = asset(self.1),
                    _ => {}
                }
            }
        }
        let Some((name, mut thing)) = self.selected_thing() else { return };
        let known = thing.components.get(tag).cloned();
        let Some(mut component) = known.or_else(|| add::fresh(tag, self.session.document.registry())) else { return };
        component.visit(&mut Setter(field, file));
        thing.components.insert(component.tag(), component);
        self.session.bring(format!("File of {}", name.as_str()), &name, thing);
    }

    pub(super) fn save_picture(&mut self, file: &Path) {
        let (frame, snapshot) = {
            let view = self.session.worker.view();
            (view.frame.clone(), view.snapshot.clone())
        };
        let (Some(frame), Some(snapshot)) = (frame, snapshot) else {
            self.told = Some(Told::fault("There is no picture to save", vec![]));
            return;
        };
        self.session.write_picture(file, frame, snapshot.settings.clone());
    }
}

/// The field of a component that names a file it cannot do without.
pub(super) fn file_field(component: &dyn AnyComponent) -> Option<&'static str> {
    struct Finder(Option<&'static str>);
    impl FieldVisitor for Finder {
        fn field(&mut self, name: &'static str, value: Value<'_>, spec: Spec) {
            if matches!(value, Value::Model(_) | Value::Image(_)) && spec.required {
                self.0 = Some(name);
            }
        }
    }
    let mut finder = Finder(None);
    component.copy().visit(&mut finder);
    finder.0
}
