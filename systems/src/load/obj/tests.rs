//! Whole files, as text, with exactly what is found in them.

use super::*;
use glam::DVec3;
use snell_components::color::Rgb;
use snell_components::material::Highlight;

/// A cube's corner: three axes and the origin.
const CORNER: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";

/// Reads `model.obj` beside other files; messages without the folder.
fn read_with(obj: &[u8], others: &[(&str, &[u8])]) -> Result<(Model, Vec<String>), Vec<String>> {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, contents) in others {
        std::fs::write(folder.path().join(name), contents).expect("written");
    }
    let path = folder.path().join("model.obj");
    std::fs::write(&path, obj).expect("written");
    let prefix = format!("{}/", folder.path().display());
    let plain = |message: String| message.replace(&prefix, "");
    match super::read(&path) {
        Ok((model, notices)) => Ok((model, notices.iter().map(|notice| plain(notice.to_string())).collect())),
        Err(faults) => Err(faults.0.iter().map(|fault| plain(fault.to_string())).collect()),
    }
}

fn read(obj: &str) -> (Model, Vec<String>) {
    read_with(obj.as_bytes(), &[]).unwrap_or_else(|faults| panic!("{faults:#?}"))
}

fn faults(obj: &str) -> Vec<String> {
    read_with(obj.as_bytes(), &[]).err().unwrap_or_default()
}

fn material(mtl: &str) -> (ModelMaterial, Vec<String>) {
    let obj = format!("mtllib a.mtl\n{CORNER}usemtl a\nf 1 2 3\n");
    let (mut model, notices) =
        read_with(obj.as_bytes(), &[("a.mtl", format!("newmtl a\n{mtl}").as_bytes())]).expect("a model");
    let mut material = model.materials.remove(0);
    let line =
        material.line.take().map(|line| (line.file.file_name().is_some_and(|name| name == "a.mtl"), line.number));
    assert_eq!(line, Some((true, 1)));
    (material, notices)
}

fn area(mesh: &TriangleMesh) -> DVec3 {
    (0..mesh.len()).map(|i| mesh.corners(i)).map(|[a, b, c]| (b - a).cross(c - a) / 2.0).sum()
}

#[test]
fn a_plain_file_is_read_without_a_notice() {
    let (model, notices) =
        read(&format!("# a tetrahedron\no t\ng a b\ns off\n{CORNER}f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"));
    assert_eq!((model.mesh.len(), model.materials.len(), notices), (4, 0, vec![]));
    assert_eq!(model.mesh.corners(3), [DVec3::X, DVec3::Y, DVec3::Z]);
}

#[test]
fn numbers_are_faulted_where_they_stand() {
    let text = "v 0 nan 0\nv 1 0 1e39\nv 0 1,5 0\nv 1 2\nv 1 2 3 4 5\nvt\nvn 0 1\nv 1.#INF 0 0\nvt 0 0 0 0\n";
    assert_eq!(
        faults(text),
        [
            "model.obj:1:5: `nan` is not finite",
            "model.obj:2:7: `1e39` is beyond the range of single precision",
            "model.obj:3:5: `1,5` is not a number; decimals take a point",
            "model.obj:4:1: a vertex has 3 numbers, 4 with a weight, 6 or 7 with a colour, this has 2",
            "model.obj:5:1: a vertex has 3 numbers, 4 with a weight, 6 or 7 with a colour, this has 5",
            "model.obj:6:1: a texture coordinate has 1 to 3 numbers, this has 0",
            "model.obj:7:1: a normal has 3 numbers, this has 2",
            "model.obj:8:3: `1.#INF` is not a number",
            "model.obj:9:1: a texture coordinate has 1 to 3 numbers, this has 4",
        ]
    );
}

#[test]
fn indices_are_faulted_where_they_stand() {
    let text = format!(
        "{CORNER}vt 0 0\nf 1 2 5\nf 0 1 2\nf -5 1 2\nf 1/2 2/1 3/1\nf 1 2\nf\nf a 2 3\nf 1/1/1/1 2 3\nf 1.0 2 3\n\
         f 1 2 99999999999999999999\n  f /1 2 3\nf 1//-1 2 3\n"
    );
    assert_eq!(
        faults(&text),
        [
            "model.obj:6:7: there is no vertex 5: the file has 4",
            "model.obj:7:3: there is no vertex 0: they count from 1",
            "model.obj:8:3: there is no vertex -5: 4 stand above",
            "model.obj:9:5: there is no texture coordinate 2: the file has 1",
            "model.obj:10:1: a face needs 3 corners, this has 2",
            "model.obj:11:1: a face needs 3 corners, this has 0",
            "model.obj:12:3: `a` is not the index of a vertex",
            "model.obj:13:9: `1/1/1/1` has more than 3 indices",
            "model.obj:14:3: `1.0` is not the index of a vertex",
            "model.obj:15:7: there is no vertex 9223372036854775807: the file has 4",
            "model.obj:16:5: `` is not the index of a vertex",
            "model.obj:17:6: there is no normal -1: 0 stand above",
        ]
    );
}

#[test]
fn relative_and_later_indices_are_resolved() {
    let (model, notices) = read("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf -1 -2 -3\nv 0 0 9\nf -1 1 -3\n");
    assert_eq!((model.mesh.len(), notices), (3, vec![]));
    assert_eq!(model.mesh.corners(0), [DVec3::ZERO, DVec3::X, DVec3::Y]);
    assert_eq!(model.mesh.corners(1), [DVec3::Y, DVec3::X, DVec3::ZERO]);
    assert_eq!(model.mesh.corners(2), [DVec3::Z * 9.0, DVec3::ZERO, DVec3::X]);
}

#[test]
fn a_file_without_faces_is_a_fault() {
    for text in ["", "\n", "# nothing\n", CORNER, "v 0 0 0\nv 1 0 0\nl 1 2\n"] {
        assert_eq!(faults(text), ["model.obj: has no faces"]);
    }
}

#[test]
fn faults_beyond_a_limit_are_counted() {
    let found = faults(&"v x\n".repeat(1000));
    assert_eq!(found.len(), 21);
    assert_eq!(found[19], "model.obj:20:3: `x` is not a number");
    assert_eq!(found[20], "model.obj: and 980 more faults");
    // Those known only at the end of the file are sorted in.
    let found = faults(&format!("f 1 2 3\n{}", "v x\n".repeat(1000)).replace("f 1 2 3", "f 1 2 1001"));
    assert_eq!(found[0], "model.obj:1:7: there is no vertex 1001: the file has 1000");
}

#[test]
fn every_way_to_end_and_continue_lines_gives_the_same_mesh() {
    let text = format!("{CORNER}f 1 2 3 # a comment\n");
    let corners = read(&text).0.mesh.corners(0);
    for text in [
        text.replace('\n', "\r\n"),
        text.replace('\n', "\r"),
        text.replace(" 2 3", " \\\n2 \\\r\n 3"),
        text.trim_end().to_owned(),
        format!("\u{feff}{text}"),
        text.replace(' ', "\t  "),
        text.replace("f 1 2 3", &format!("f 1{}2 3", " ".repeat(100_000))),
    ] {
        let (model, notices) = read(&text);
        assert_eq!((model.mesh.len(), model.mesh.corners(0), notices), (1, corners, vec![]), "{text:.60}");
    }
    assert_eq!(faults("v 0 \\\n  x 0\n"), ["model.obj:2:3: `x` is not a number"]);
}

#[test]
fn what_is_passed_over_is_counted() {
    let text = format!("{CORNER}l 1 2\np 1\nl 2 3\ncurv 0 1\nfoo\nv 1 1 1 1 0 0\nv 1 1 1 0.5\nf 1 2 3\n");
    let (model, notices) = read(&text);
    assert_eq!(model.mesh.len(), 1);
    assert_eq!(
        notices,
        [
            "model.obj:5:1: `l` passed over: points and lines have no surface (2 times, first here)",
            "model.obj:6:1: `p` passed over: points and lines have no surface",
            "model.obj:8:1: `curv` passed over: curved surfaces are not read",
            "model.obj:9:1: `foo` passed over: unknown statement",
            "model.obj:10:1: a vertex with a colour is read without",
            "model.obj:11:1: a vertex with a weight, which only curves use, is read without",
        ]
    );
    let many: String = (0..100).map(|i| format!("word{i}\n")).collect();
    let (_, notices) = read(&format!("{CORNER}{many}f 1 2 3\n"));
    assert_eq!((notices.len(), &*notices[50]), (51, "model.obj: and 50 more notices of other kinds"));
}

#[test]
fn bytes_of_other_encodings_do_no_harm_in_names_and_comments() {
    let obj = [b"# caf\xe9\nusemtl \xe9\n", CORNER.as_bytes(), b"f 1 2 3\n"].concat();
    let (model, notices) = read_with(&obj, &[]).expect("a model");
    assert_eq!(model.materials[0].name, "\u{fffd}");
    assert_eq!(
        notices,
        [
            "model.obj:1:1: a line with bytes that are not UTF-8, each read as `\u{fffd}` (2 times, first here)",
            "model.obj:2:1: a material without a library that could be read is plain white",
        ]
    );
    let found = read_with(b"v 0 0 \xe9\n", &[]).expect_err("a fault");
    assert_eq!(found, ["model.obj:1:7: `\u{fffd}` is not a number"]);
    let found = read_with(b"\xff\xfev\0 \0", &[]).expect_err("a fault");
    assert_eq!(found, ["model.obj: is not UTF-8 but seems to be UTF-16: save it as UTF-8"]);
}

#[test]
fn corners_with_and_without_attributes_may_mix() {
    let text = format!(
        "{CORNER}vt 0 0\nvt 1 0\nvt 0.5\nvn 0 0 2\nvn 0 0 0\nf 1 2 3\nf 1/1/1 2/2/1 3/3/1\nf 1//1 2//1 3//2\nf 1/1 2/ 3//\n"
    );
    let (model, notices) = read(&text);
    assert_eq!(model.mesh.len(), 4);
    assert_eq!(
        notices,
        ["model.obj:13:1: a face with a texture coordinate at only some of its corners: it is left without"]
    );
    let (model, notices) = read(&format!("{CORNER}f 1/1/1 2/2/2 3/3/3\n"));
    assert_eq!(model.mesh.len(), 1);
    assert_eq!(
        notices,
        [
            "model.obj:5:5: the file has no texture coordinates: a corner's index of one is passed over (3 times, first here)",
            "model.obj:5:7: the file has no normals: a corner's index of one is passed over (3 times, first here)",
        ]
    );
}

#[test]
fn polygons_keep_their_area_and_their_attributes() {
    let text = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nv 0 0 1\nvn 0 0 1\n\
                f 1//1 2//1 3//1 4//1 5//1 6//1\nf 1 2 7\n";
    let (model, notices) = read(text);
    assert_eq!((model.mesh.len(), notices), (5, vec![]));
    assert_eq!(area(&model.mesh), DVec3::new(0.0, -1.0, 3.0));
}

#[test]
fn crossed_and_empty_faces_are_noticed() {
    let (model, notices) = read("v 0 0 0\nv 1 1 0\nv 2 0 0\nv 0 1 0\nf 1 2 3 4\nf 1 1 2\nf 1 2 2 1\n");
    assert_eq!((model.mesh.len(), model.mesh.degenerate()), (2, 3));
    assert_eq!(
        notices,
        [
            "model.obj: a face that crosses itself, has no area or has too many corners is cut as a fan (2 times, first here)",
            "model.obj: triangles without an area left out: 3",
        ]
    );
}

#[test]
fn slots_are_the_materials_that_faces_use() {
    let obj = format!(
        "mtllib a.mtl missing.mtl\n{CORNER}f 1 2 3\nusemtl unused\nusemtl b b\nf 1 2 4\nusemtl Read\nf 1 3 4\nusemtl b b\nf 2 3 4\n"
    );
    let mtl = b"newmtl red\nKd 1 0 0\nnewmtl b b\nKd 0 0 1\nnewmtl unused\nmap_Kd missing.png\n";
    let (model, notices) = read_with(obj.as_bytes(), &[("a.mtl", mtl)]).expect("a model");
    let names: Vec<_> = model.materials.iter().map(|material| material.name.as_str()).collect();
    assert_eq!(names, ["b b", "Read", ""]);
    assert_eq!(model.materials[0].color, Rgb::Z);
    assert_eq!(model.materials[2], ModelMaterial::default());
    assert_eq!(
        notices,
        [
            "model.obj:1:1: material library missing.mtl: does not exist",
            "model.obj:10:1: there is no material `Read` (did you mean `red`?): it is plain white",
        ]
    );
}

#[test]
fn libraries_are_searched_in_order() {
    let obj = format!("mtllib one.mtl\nmtllib two.mtl\nmtllib one.mtl\n{CORNER}usemtl a\nf 1 2 3\n");
    let others: [(&str, &[u8]); 2] = [("one.mtl", b"newmtl a\nKd 1 0 0\n"), ("two.mtl", b"newmtl a\nKd 0 1 0\n")];
    let (model, notices) = read_with(obj.as_bytes(), &others).expect("a model");
    assert_eq!(model.materials[0].color, Rgb::X);
    assert_eq!(notices, ["two.mtl:1:1: material `a` is defined before; this one is passed over"]);
    let spaced = obj.replace("one.mtl", "my one.mtl").replace("two.mtl", "my one.mtl");
    let (model, notices) = read_with(spaced.as_bytes(), &[("my one.mtl", others[1].1)]).expect("a model");
    assert_eq!((model.materials[0].color, notices), (Rgb::Y, vec![]));
    let (_, notices) = read_with(obj.as_bytes(), &[("One.mtl", others[0].1)]).expect("a model");
    assert!(notices[0].ends_with("(did you mean `One.mtl`?)"), "{notices:?}");
}

#[test]
fn faults_of_the_model_and_its_libraries_come_together() {
    let obj = format!("mtllib a.mtl\n{CORNER}v\nusemtl a\nf 1 2 3\n");
    let mtl = b"newmtl a\nKd 1 0\nKs 1 0 x\nNs\nillum 2.5\nd -1\nNi nan\n";
    assert_eq!(
        read_with(obj.as_bytes(), &[("a.mtl", mtl)]).expect_err("faults"),
        [
            "model.obj:6:1: a vertex has 3 numbers, 4 with a weight, 6 or 7 with a colour, this has 0",
            "a.mtl:2:1: a colour has 3 numbers, or 1 for a grey, this has 2",
            "a.mtl:3:8: `x` is not a number",
            "a.mtl:4:1: `Ns` has 1 number, this has none",
            "a.mtl:5:7: `illum` has the number of a model of illumination, 0 to 10",
            "a.mtl:7:4: `nan` is not finite",
        ]
    );
}

#[test]
fn materials_become_terms_of_the_shading_equation() {
    let (plain, notices) = material("");
    assert_eq!((plain, notices), (ModelMaterial::named("a"), vec![]));
    let (phong, notices) = material("Ka 0.25 0.5 1\nKd 0.5\nKs 0 0.25 0.5\nNs 50\nillum 2\nd 1\n");
    let expected = ModelMaterial {
        name: "a".into(),
        color: Rgb::splat(0.5),
        ambient: Rgb::new(0.5, 1.0, 1.0),
        highlight: Some(Highlight { strength: Rgb::new(0.0, 0.25, 0.5), exponent: 50.0 }),
        ..ModelMaterial::default()
    };
    assert_eq!((phong, notices), (expected, vec![]));
    for (mtl, highlight, mirror) in [
        ("Ks 1 1 1\n", false, false),
        ("Ks 1 1 1\nNs 9\n", true, false),
        ("Ks 1 1 1\nNs 9\nillum 1\n", false, false),
        ("Ks 1 1 1\nNs 9\nillum 3\n", true, true),
        ("Ks 1 1 1\nillum 5\n", false, true),
        ("Ks 0 0 0\nNs 9\nillum 3\n", false, false),
        ("Ks 1 1 1\nNs 9\nillum 8\n", true, false),
    ] {
        let (material, _) = material(mtl);
        assert_eq!((material.highlight.is_some(), material.mirror.is_some()), (highlight, mirror), "{mtl}");
    }
    for (mtl, opacity, index) in [
        ("d 0.25\n", 0.25, None),
        ("Tr 0.25\n", 0.75, None),
        ("d 0.5\nTr 0.25\n", 0.5, None),
        ("Tr 0.25\nd 0.5\n", 0.5, None),
        ("d -halo 0.5\n", 0.5, None),
        ("d 0.5\nNi 1.5\n", 0.5, Some(1.5)),
        ("d 0.5\nNi 1.5\nillum 2\n", 0.5, None),
        ("d 0.5\nNi 1.5\nillum 7\n", 0.5, Some(1.5)),
        ("d 1\nNi 1.5\nillum 7\n", 1.0, None),
        ("d 0.5\nNi 1\nillum 7\n", 0.5, None),
    ] {
        let (material, _) = material(mtl);
        assert_eq!((material.opacity, material.index), (opacity, index), "{mtl}");
    }
    assert_eq!(material("illum 0\n").0.ambient, Rgb::ZERO);
}

#[test]
fn material_values_out_of_range_are_brought_into_it() {
    let (found, notices) =
        material("Kd -1 0.5 2\nKs 4 4 4\nNs 1e38\nd 1.5\nNi -1\nillum 300\nKe 1 1 1\nmap_Bump -bm 1 a.png\n");
    assert_eq!(found.color, Rgb::new(0.0, 0.5, 2.0));
    assert_eq!(found.highlight, Some(Highlight { strength: Rgb::splat(4.0), exponent: 1e6 }));
    assert_eq!((found.opacity, found.mirror), (1.0, None));
    assert_eq!(
        notices,
        [
            "a.mtl:1:1: material `a`: `Kd` of -1 is taken as 0",
            "a.mtl:1:1: material `a`: `illum` of 255 is taken as 2",
            "a.mtl:1:1: material `a`: `Ns` of 99999996802856920000000000000000000000 is taken as 1000000",
            "a.mtl:1:1: material `a`: `d` of 1.5 is taken as 1",
            "a.mtl:1:1: material `a`: `Ni` of -1 is no refractive index",
            "a.mtl:8:1: `Ke` passed over: a property without a counterpart",
            "a.mtl:9:1: `map_Bump` passed over: of the textures only `map_Kd` is read",
        ]
    );
    assert_eq!(
        material("d 0\nKd spectral a.rfl 1\nTr 1 2\n").1,
        [
            "a.mtl:1:1: material `a` has no opacity: its faces do not show",
            "a.mtl:3:4: a colour as `spectral` passed over",
            "a.mtl:4:1: `Tr` has 1 number: those after it passed over",
        ]
    );
}

#[test]
fn textures_are_found_beside_the_library_and_shared() {
    let image = ::image::RgbImage::from_pixel(2, 3, ::image::Rgb([255, 0, 0]));
    let mut png = std::io::Cursor::new(vec![]);
    image.write_to(&mut png, ::image::ImageFormat::Png).expect("written");
    let obj = format!("mtllib a.mtl\n{CORNER}usemtl a\nf 1 2 3\nusemtl b\nf 1 2 4\nusemtl c\nf 1 3 4\n");
    let mtl = b"newmtl a\nmap_Kd my red.png\nnewmtl b\nmap_Kd -s 2 2 -o 1 -clamp on -mm 0 1 .\\my red.png\nnewmtl c\nmap_Kd my rad.png\n";
    let (model, notices) =
        read_with(obj.as_bytes(), &[("a.mtl", mtl), ("my red.png", png.get_ref())]).expect("a model");
    let size = |i: usize| model.materials[i].texture.as_ref().map(|(_, image)| image.size());
    assert_eq!((size(0), size(1), size(2)), (Some((2, 3)), Some((2, 3)), None));
    let is_shared = |[a, b]: [usize; 2]| match (&model.materials[a].texture, &model.materials[b].texture) {
        (Some((_, a)), Some((_, b))) => Arc::ptr_eq(a, b),
        _ => false,
    };
    assert!(is_shared([0, 1]));
    assert_eq!(
        notices,
        [
            "a.mtl:4:8: the texture option `-s` passed over",
            "a.mtl:4:15: the texture option `-o` passed over",
            "a.mtl:4:20: the texture option `-clamp` passed over",
            "a.mtl:4:30: the texture option `-mm` passed over",
            "a.mtl:5:1: texture my rad.png: does not exist (did you mean `my red.png`?)",
        ]
    );
}

#[test]
fn names_that_mean_something_to_the_parser_do_no_harm() {
    for name in ["", "#", "Material #1", "newmtl", "a\u{85}b", "ä ö", "0"] {
        let obj = format!("mtllib a.mtl\n{CORNER}usemtl {name}\nf 1 2 3\n");
        let mtl = format!("newmtl {name}\nKd 0 1 0\n");
        let (model, notices) = read_with(obj.as_bytes(), &[("a.mtl", mtl.as_bytes())]).expect("a model");
        assert_eq!((model.materials[0].color, notices), (Rgb::Y, vec![]), "{name}");
    }
}

#[test]
fn what_passes_the_check_never_fails_in_the_parser() {
    const OBJ: &str = "mtllib a.mtl\no x\nv 0 0 0\nv 1.5e0 0 0\nv -0.5 +1. 0 # c\nv 0 0 1 1 0 0\nvt 0 1\nvt 0.5\nvn 0 0 1\n\
                       usemtl a\nf 1/1/1 2/2/1 3/1/1\nf -1 -2 -3 \\\n 1\nusemtl b\nf 1//1 2//1 4//1\nl 1 2\ns 1\ng\nf 1/1 2/2 3/\n";
    const MTL: &str = "newmtl a\nKa 0 0 0\nKd 0.5\nKs 1 1 1\nNs 10\nNi 1.5\nd -halo 0.5\nTr 0.5\nillum 7\n\
                       map_Kd -s 1 2 b.png\nnewmtl b\nKe 1 1 1\nbump a.png\n";
    const PIECES: [&[u8]; 24] = [
        b" ",
        b"\n",
        b"\r",
        b"/",
        b"//",
        b"-",
        b"0",
        b"9",
        b".",
        b"e",
        b"#",
        b"\\\n",
        b"v",
        b"f ",
        b"vn",
        b"vt",
        b"nan",
        b"\xff",
        b"\0",
        b"99999999999999999999",
        b"newmtl",
        b"usemtl ",
        b"l 1 2 3\n",
        b"\xc2\x85",
    ];
    let mut state = 7u64;
    let mut random = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    let mut mutated = |text: &str| {
        let mut bytes = text.as_bytes().to_vec();
        for _ in 0..1 + random(4) {
            let at = random(bytes.len());
            let end = (at + random(4)).min(bytes.len());
            let piece = if random(3) == 0 { &[][..] } else { PIECES[random(PIECES.len())] };
            bytes.splice(at..end, piece.iter().copied());
        }
        bytes
    };
    let (mut accepted, mut refused) = (0, 0);
    for _ in 0..500 {
        let (obj, mtl) = (mutated(OBJ), mutated(MTL));
        let messages = match read_with(&obj, &[("a.mtl", &mtl)]) {
            Ok((model, notices)) => {
                accepted += 1;
                assert!(model.mesh.len() + model.mesh.degenerate() > 0);
                notices
            }
            Err(faults) => {
                refused += 1;
                assert!(!faults.is_empty());
                faults
            }
        };
        let failed = messages.iter().find(|message| message.contains("cannot be parsed"));
        assert_eq!(failed, None, "{}\n{}", String::from_utf8_lossy(&obj), String::from_utf8_lossy(&mtl));
    }
    assert!(accepted > 50 && refused > 50, "{accepted} accepted, {refused} refused");
}

#[test]
fn faces_are_those_that_another_reader_finds() {
    // Triangles and larger faces, with and without attributes, relative indices, comments, continued lines.
    let mut text =
        String::from("# numbers of every form\nv 0 0 0\nv 1.5e0 0 -0\nv .5 +1. 1e-40\nv -0.1 7 3\nv 1 1 0.3\n");
    text += "vt 0.25 .5\nvt 1 0\nvt 0 1\nvn 0 0 1\nvn 0 1 0\n";
    for i in 0..200 {
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| (i * 7 + k * (1 + i % 2)) % 5 + 1);
        text += &match i % 4 {
            0 => format!("f {a} {b} {c}\n"),
            1 => format!("f {a}/1/2 {b}/3/1 {c}/2/2 # {d}\n"),
            2 => format!("f {}//-1 \\\n {b}//1 {c}//2\n", a - 6),
            _ => format!("f {a}/1 {b}/2 {c}/3\n"),
        };
    }
    let (model, _) = read(&text);
    // What the other reader is known to handle: no comments behind faces, no continued lines, no attributes at some only.
    let plain: String = text
        .replace("\\\n", "")
        .lines()
        .map(|line| {
            let words: Vec<&str> = line
                .split_whitespace()
                .take_while(|word| *word != "#")
                .map(|word| word.split('/').next().unwrap_or(word))
                .collect();
            words.join(" ") + "\n"
        })
        .collect();
    let no_library = |_: &Path| Err(tobj::LoadError::OpenFileFailed);
    let (models, _) =
        tobj::load_obj_buf(&mut plain.as_bytes(), &tobj::LoadOptions::default(), no_library).expect("a model");
    let other = &models[0].mesh;
    let point = |i: u32| DVec3::from_array([0, 1, 2].map(|k| f64::from(other.positions[3 * i as usize + k])));
    let theirs = other.indices.as_chunks::<3>().0.iter().map(|triangle| triangle.map(point));
    let theirs: Vec<_> = theirs.filter(|[a, b, c]| (b - a).cross(c - a) != DVec3::ZERO).collect();
    let ours: Vec<_> = (0..model.mesh.len()).map(|i| model.mesh.corners(i)).collect();
    assert!(ours.len() > 100);
    assert_eq!(ours, theirs);
}
