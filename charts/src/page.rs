//! Files: charts as SVG and PNG, tables as CSV and JSON, pictures, and one page that puts them together (HTML, and
//! Markdown to be put into other texts).

use crate::{
    chart,
    study::Found,
    table::{Cell, Table},
};
use serde::Serialize;
use snell_systems::image::{self, Format, Metadata};
use std::{
    fmt::Write,
    fs, io,
    path::{Path, PathBuf},
};

/// Everything of some studies, as JSON.
#[derive(Serialize)]
struct Json<'a> {
    title: &'a str,
    about: &'a str,
    studies: Vec<JsonStudy<'a>>,
}

#[derive(Serialize)]
struct JsonStudy<'a> {
    name: &'a str,
    title: &'a str,
    says: &'a [String],
    table: &'a Table,
}

/// Writes all files of some studies into a folder, which is made if it is not there; gives the page.
///
/// # Errors
/// A file that cannot be written, or a chart that cannot be drawn.
pub fn write(folder: &Path, title: &str, about: &str, studies: &[Found]) -> io::Result<PathBuf> {
    fs::create_dir_all(folder)?;
    for study in studies {
        for chart in &study.charts {
            fs::write(folder.join(format!("{}.svg", chart.file)), chart::svg(chart).map_err(io::Error::other)?)?;
            fs::write(folder.join(format!("{}.png", chart.file)), chart::png(chart).map_err(io::Error::other)?)?;
        }
        fs::write(folder.join(format!("{}.csv", study.name)), study.table.csv())?;
        for (n, (_, picture)) in study.pictures.iter().enumerate() {
            let file = folder.join(picture_name(study, n));
            image::write(&file, Format::Png8, picture, &Metadata::default())
                .map_err(|why| io::Error::other(why.to_string()))?;
        }
    }
    let json = Json {
        title,
        about,
        studies: studies
            .iter()
            .map(|study| JsonStudy { name: &study.name, title: &study.title, says: &study.says, table: &study.table })
            .collect(),
    };
    fs::write(folder.join("charts.json"), serde_json::to_vec_pretty(&json)?)?;
    fs::write(folder.join("charts.md"), markdown(about, studies))?;
    let page = folder.join("index.html");
    fs::write(&page, html(title, about, studies))?;
    Ok(page)
}

fn picture_name(study: &Found, n: usize) -> String {
    format!("{}-picture-{}.png", study.name, n + 1)
}

const STYLE: &str = "\
body{font:16px/1.5 system-ui,sans-serif;color:#222;max-width:1000px;margin:2em auto;padding:0 1em}\
h1{font-size:1.6em}h2{font-size:1.25em;margin-top:2.5em;border-top:1px solid #ccc;padding-top:1em}\
img.chart{width:100%;max-width:960px;display:block;margin:1em 0}\
figure{display:inline-block;margin:0 1em 1em 0;max-width:300px;vertical-align:top}figure img{width:100%;image-rendering:pixelated}\
figcaption{font-size:.85em;color:#555}table{border-collapse:collapse;font-size:.8em}\
td,th{padding:.2em .6em;border-bottom:1px solid #ddd;text-align:right;white-space:nowrap}\
td:nth-child(-n+2),th:nth-child(-n+2){text-align:left;white-space:normal}.wide{overflow-x:auto}\
footer{margin-top:3em;font-size:.85em;color:#555}";

fn html(title: &str, about: &str, studies: &[Found]) -> String {
    let mut page = format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\">\
         <title>{0}</title><style>{STYLE}</style></head><body>\n<h1>{0}</h1>\n",
        escaped(title)
    );
    // Into a string, which takes everything.
    for study in studies {
        let _ = writeln!(page, "<h2 id=\"{}\">{}</h2>\n<ul>", escaped(&study.name), escaped(&study.title));
        for sentence in study.says.iter().filter(|sentence| !sentence.is_empty()) {
            let _ = writeln!(page, "<li>{}</li>", escaped(sentence));
        }
        page.push_str("</ul>\n");
        for chart in &study.charts {
            let _ =
                writeln!(page, "<img class=\"chart\" src=\"{}.svg\" alt=\"{}\">", chart.file, escaped(&chart.title));
        }
        for (n, (caption, _)) in study.pictures.iter().enumerate() {
            let _ = writeln!(
                page,
                "<figure><img src=\"{}\" alt=\"\"><figcaption>{}</figcaption></figure>",
                escaped(&picture_name(study, n)),
                escaped(caption)
            );
        }
        let _ = write!(
            page,
            "<details open><summary>Numbers (<a href=\"{0}.csv\">{0}.csv</a>)</summary>\n{1}</details>\n",
            study.name,
            rows(&study.table)
        );
    }
    let _ = write!(
        page,
        "<footer>{} All numbers: <a href=\"charts.json\">charts.json</a>.</footer>\n</body></html>\n",
        escaped(about)
    );
    page
}

/// The charts with what they say, to be put into other texts; short tables in full.
fn markdown(about: &str, studies: &[Found]) -> String {
    let mut text = String::new();
    for study in studies {
        let says: Vec<&str> = study.says.iter().map(String::as_str).filter(|sentence| !sentence.is_empty()).collect();
        let _ = write!(text, "## {}\n\n{}\n\n", study.title, says.join(" "));
        for chart in &study.charts {
            let _ = write!(text, "![{}]({}.svg)\n\n", chart.title, chart.file);
        }
        if study.charts.is_empty() {
            let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
            text += &line(study.table.columns.clone());
            text += &line(vec!["---".into(); study.table.columns.len()]);
            study.table.rows.iter().for_each(|row| text += &line(row.iter().map(Cell::to_string).collect()));
            text.push('\n');
        }
    }
    let _ = writeln!(text, "{about}");
    text
}

fn rows(table: &Table) -> String {
    let mut html = String::from("<div class=\"wide\"><table><tr>");
    for column in &table.columns {
        let _ = write!(html, "<th>{}</th>", escaped(column));
    }
    html.push_str("</tr>\n");
    for row in &table.rows {
        html.push_str("<tr>");
        row.iter().map(Cell::to_string).for_each(|cell| {
            let _ = write!(html, "<td>{}</td>", escaped(&cell));
        });
        html.push_str("</tr>\n");
    }
    html.push_str("</table></div>\n");
    html
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
