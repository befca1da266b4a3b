use super::*;

fn formatted(text: &str) -> String {
    let once = format_scene(text, Path::new("a.ron")).unwrap_or_else(|faults| panic!("{text}: {faults}"));
    let twice = format_scene(&once, Path::new("a.ron")).unwrap_or_else(|faults| panic!("{once}: {faults}"));
    assert_eq!(once, twice, "of {text}");
    once
}

#[test]
fn short_values_stand_in_one_line_and_open_brackets_stay_open() {
    let text = "Scene(version :1,entities:{ \"a\" : [ Sphere( radius:1 , ) ,],\n}, )";
    assert_eq!(formatted(text), "Scene(version: 1, entities: {\"a\": [Sphere(radius: 1)]})\n");
    let text = "Scene(\nversion: 1, entities: {\n\n\n\"a\": [Sphere(radius: 1)], \"b\": [\nPlane]\n\n\n, \"c\":[]}\n)";
    let expected = "Scene(\n    version: 1,\n    entities: {\n        \"a\": [Sphere(radius: 1)],\n        \"b\": [\n            Plane,\n        ],\n        \"c\": [],\n    },\n)\n";
    assert_eq!(formatted(text), expected);
}

#[test]
fn comments_stay_with_their_values() {
    let text = "// first\n\n// second\nScene( // here\n version: /* one */ 1,// behind\n\n  /* above\n   twice */\n  entities: {}, // end\n  // last\n)\n// after";
    let expected = "// first\n\n// second\nScene(\n    // here\n    version: /* one */ 1, // behind\n\n    /* above\n   twice */\n    entities: {}, // end\n    // last\n)\n// after\n";
    assert_eq!(formatted(text), expected);
    assert_eq!(formatted("(a: // why\n 1)"), "(\n    // why\n    a: 1,\n)\n");
    assert_eq!(formatted("[1, /* two */ 2]"), "[1, /* two */ 2]\n");
}

#[test]
fn long_values_are_opened() {
    let numbers = |count: usize| vec!["(0.123456, 0.234567, 0.345678)"; count].join(", ");
    let text = formatted(&format!("Scene(version: 1, entities: {{\"a\": [Triangle(normals: [{}])]}})", numbers(5)));
    assert!(text.lines().all(|line| line.len() <= 120), "{text}");
    assert_eq!(formatted(&format!("[{}]", numbers(3))), format!("[{}]\n", numbers(3)));
}

#[test]
fn texts_and_odd_tokens_are_left_alone() {
    for text in [
        r##"[r#"a " // b"#, "/* \" ", 'c', '\'', '"', b"x", b'a', r#type, -.5e-3, inf]"##,
        "#![enable(implicit_some)]\n(a: 1)",
        "(r#type: r#x(1, 2))",
        "\"ä // ö\"",
        "()",
    ] {
        assert_eq!(formatted(text).trim_end(), text);
    }
    assert_eq!(formatted("\u{FEFF}(a:\r\n1)\r\n"), "(a: 1)\n");
}

#[test]
fn what_is_not_ron_is_a_fault_with_its_place() {
    let faults = format_scene("Scene(\n  version: 1,\n  a b\n)", Path::new("a.ron")).expect_err("a fault");
    assert!(faults.to_string().starts_with("a.ron:3:"), "{faults}");
}

#[test]
fn any_layout_of_a_text_is_laid_out_alike_again() {
    // Every token in a line of its own.
    let text = include_str!("../../../../scenes/gallery/behind-glass.ron");
    let torn = |between: &str| -> String {
        let tokens = tokens(text).expect("tokens");
        tokens
            .iter()
            .map(|token| format!("{}{}", token.text, if token.is_line_comment() { "\n" } else { between }))
            .collect()
    };
    for between in [" ", "\n", "\n\n\n"] {
        formatted(&torn(between));
    }
}
