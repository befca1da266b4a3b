//! Scenes with one large model, from the text of the files to the first ray.

use crate::{
    clock::spent,
    measure::{Case, Done, Row, interleave},
    subject::Subject,
};
use snell::{Renderer, components::primitive::Cost};
use std::{fs, io, io::Write, path::Path};

/// Writes all subjects as OBJ and reads them: the model alone, and with its tree.
pub(crate) fn bench(subjects: &[Subject], rounds: usize) -> io::Result<Vec<Row>> {
    let folder = tempfile::tempdir()?;
    let mut files = vec![];
    for subject in subjects {
        let file = folder.path().join(format!("{}.obj", files.len()));
        write_obj(subject, &file)?;
        files.push((subject, fs::metadata(&file)?.len(), file));
    }
    let cases = files.iter().flat_map(|(subject, bytes, file)| {
        let case = |threads: usize, with_tree: bool| {
            let mesh = format!(r#""mesh": [Mesh(model: "{}")]"#, file.display());
            let text = format!(r#"Scene(version: 1, entities: {{ "eye": [Camera(position: (0, 0, 9))], {mesh} }})"#);
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            let read = move || {
                let mut renderer = Renderer::new();
                renderer.load_text(&text, Path::new("scene.ron")).expect("a sound file");
                if with_tree {
                    renderer.snapshot().expect("a scene that can be drawn");
                }
            };
            let items = if with_tree { subject.triangles.len() as u64 } else { *bytes };
            Case {
                bench: "load",
                subject: format!("{}{}", subject.name, if with_tree { ", with tree" } else { "" }),
                item: if with_tree { "triangles" } else { "bytes" },
                threads,
                run: Box::new(move || {
                    let ((), spent) = spent(|| pool.install(&read));
                    Done { spent, items, cost: Cost::default() }
                }),
            }
        };
        [case(1, false), case(1, true), case(2, true)]
    });
    Ok(interleave(cases.collect(), rounds))
}

fn write_obj(subject: &Subject, file: &Path) -> io::Result<()> {
    let mut out = io::BufWriter::new(fs::File::create(file)?);
    for [x, y, z] in &subject.positions {
        writeln!(out, "v {x} {y} {z}")?;
    }
    for [a, b, c] in subject.triangles.iter().map(|corners| corners.map(|i| i + 1)) {
        writeln!(out, "f {a} {b} {c}")?;
    }
    out.flush()
}
