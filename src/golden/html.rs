//! The page that shows failures; pictures are part of it, so that one file is all there is to keep.

use super::report::{Entry, First};
use std::fmt::Write;

const STYLE: &str = "
body{font:15px/1.5 system-ui,sans-serif;margin:2rem auto;max-width:1560px;padding:0 1rem;background:#fbfbf9;color:#1b1b1a}
article{border-top:1px solid #d8d7d0;padding:1.2rem 0}h2{margin:.2rem 0;font-size:1.15rem}
pre{background:#f0efea;padding:.6rem .8rem;overflow:auto;border-radius:4px}
.row{display:flex;flex-wrap:wrap;gap:1rem}figure{margin:0}figcaption{color:#63635e;font-size:13px}
img{image-rendering:pixelated;width:var(--w);display:block;background:#000}
.marked{position:relative}.marked b{position:absolute;width:13px;height:13px;border:2px solid #fff;outline:1px solid #000;border-radius:50%;transform:translate(-50%,-50%)}
.level{display:inline-block;width:1em;height:1em;vertical-align:-.15em;border:1px solid #0005;margin:0 .35em 0 1em}
.slide{position:relative;width:var(--w)}.slide img+img{position:absolute;inset:0;clip-path:inset(0 0 0 var(--at,50%))}
.slide+input{width:var(--w)}";

/// The page of all failures in their order.
pub(super) fn page(entries: &[Entry], picture: &dyn Fn(&Entry, &str) -> Option<Vec<u8>>) -> String {
    let count = if entries.len() == 1 {
        "1 golden picture fails".into()
    } else {
        format!("{} golden pictures fail", entries.len())
    };
    let mut html = format!(
        "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\">\n<title>{count}</title>\n<style>{STYLE}</style>\n<h1>{count}</h1>\n<p>Worst first. Accept a picture only after you looked at it.</p>\n"
    );
    if entries.len() > 1 {
        let link = |(n, entry): (usize, &Entry)| {
            let what = entry.what.lines().next().unwrap_or_default();
            format!("<li><a href=\"#{n}\">{}</a>: {}</li>\n", escaped(&entry.name), escaped(what))
        };
        html += &format!("<ol>\n{}</ol>\n", entries.iter().enumerate().map(link).collect::<String>());
    }
    for (number, entry) in entries.iter().enumerate() {
        // A string takes everything that is written to it.
        let _ = article(&mut html, (number, entry), picture);
    }
    html
}

fn article(
    html: &mut String,
    (number, entry): (usize, &Entry),
    picture: &dyn Fn(&Entry, &str) -> Option<Vec<u8>>,
) -> std::fmt::Result {
    let Entry { name, what, level, bless, explain, why, first, .. } = entry;
    let [name, what, level, bless] = [name, what, level, bless].map(|text| escaped(text));
    writeln!(html, "<article id=\"{number}\"><h2>{name}</h2>\n<pre>{what}</pre><p>Asked for: {level}.")?;
    if let Some(First { levels, .. }) = first {
        let patch =
            |[r, g, b]: [u8; 3], word| format!("<i class=level style=\"background:rgb({r} {g} {b})\"></i>{word}");
        writeln!(html, "The first pixel:{}{}", patch(levels[0], "expected"), patch(levels[1], "actual"))?;
    }
    writeln!(html, "</p>")?;
    let [expected, difference, actual] =
        ["expected.png", "difference.png", "actual.png"].map(|kind| picture(entry, kind));
    // Small pictures are shown in larger pixels.
    let (width, height) = actual.as_deref().and_then(png_size).unwrap_or((96, 96));
    let shown = width * (360 / width.max(1)).max(1);
    writeln!(html, "<div style=\"--w:{shown}px\"><div class=row>")?;
    let pictures = [("Expected", &expected), ("Difference", &difference), ("Actual", &actual)];
    for (title, png) in pictures.into_iter().filter_map(|(title, png)| Some((title, png.as_ref()?))) {
        // A ring about the first pixel that differs.
        let mark = first.filter(|_| title == "Difference").map(|First { x, y, .. }| {
            let percent = |at: u32, of: u32| 100.0 * (f64::from(at) + 0.5) / f64::from(of.max(1));
            format!("<b style=\"left:{:.3}%;top:{:.3}%\"></b>", percent(x, width), percent(y, height))
        });
        let (image, mark) = (image(png), mark.unwrap_or_default());
        writeln!(html, "<figure><div class=marked>{image}{mark}</div><figcaption>{title}</figcaption></figure>")?;
    }
    if let (Some(expected), Some(actual)) = (&expected, &actual) {
        let slide = "oninput=\"this.previousElementSibling.style.setProperty('--at',this.value+'%')\"";
        writeln!(
            html,
            "<figure><div class=slide>{}{}</div><input type=range value=50 aria-label=\"expected or actual\" {slide}><figcaption>Expected | actual</figcaption></figure>",
            image(expected),
            image(actual)
        )?;
    }
    writeln!(html, "</div></div>\n<p>If the new picture is right:</p><pre>{bless}</pre>")?;
    if let Some(command) = explain {
        writeln!(html, "<p>Explain the first pixel that differs:</p><pre>{}</pre>", escaped(command))?;
    }
    if let Some(why) = why {
        let why = escaped(why);
        writeln!(
            html,
            "<details><summary>How the first pixel that differs comes about now</summary><pre>{why}</pre></details>"
        )?;
    }
    writeln!(html, "</article>")
}

fn image(png: &[u8]) -> String {
    format!("<img alt=\"\" src=\"data:image/png;base64,{}\">", base64(png))
}

/// The width and height that the header of a PNG file tells.
fn png_size(png: &[u8]) -> Option<(u32, u32)> {
    let number = |at: usize| png.get(at..at + 4)?.try_into().ok().map(u32::from_be_bytes);
    Some((number(16)?, number(20)?))
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// Bytes in letters (RFC 4648, section 4).
fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let byte = |i: usize| u32::from(chunk.get(i).copied().unwrap_or_default());
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for i in 0..4 {
            let letter = LETTERS[(bits >> (18 - 6 * i) & 63) as usize];
            text.push(if i <= chunk.len() { char::from(letter) } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_become_the_letters_of_the_standard() {
        let pairs = [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("fooba", "Zm9vYmE="),
            ("foobar", "Zm9vYmFy"),
        ];
        for (bytes, letters) in pairs {
            assert_eq!(base64(bytes.as_bytes()), letters);
        }
    }
}
