//! `snell stability`.

use super::{Console, Failure, args::StabilityArguments, machine};
use snell_stability::{Outcome, Size, cases, picture, report};
use snell_systems::image;
use std::fs;

/// Runs the stability suite, prints the table and writes it to files.
pub(super) fn stability(args: &StabilityArguments, console: &mut Console<'_>) -> Result<(), Failure> {
    let size = if args.deep { Size::Deep } else { Size::Fast };
    let chosen: Vec<_> = cases()
        .into_iter()
        .filter(|case| args.case.is_empty() || args.case.iter().any(|id| id.eq_ignore_ascii_case(case.id)))
        .collect();
    if chosen.is_empty() {
        let known: Vec<_> = cases().iter().map(|case| case.id).collect();
        return Err(Failure::Usage(format!("there is no such case; there are {}", known.join(", "))));
    }
    let mut outcome = Outcome { rows: vec![] };
    for case in &chosen {
        console.note(format!("{} {}", case.id, case.name));
        outcome.rows.extend(case.run(size));
    }
    let form = if args.deep { "deep" } else { "fast" };
    let about = format!("Snell {}, {form} form, {}", env!("CARGO_PKG_VERSION"), machine::about());
    let table = format!("{about}.\n\n{}", report::markdown(&outcome));
    console.say(&table);
    if let Some(folder) = &args.output {
        let work = |why: String| Failure::Work(why);
        fs::create_dir_all(folder).map_err(|why| work(format!("{}: {why}", folder.display())))?;
        let json = report::json(&outcome).map_err(|why| work(why.to_string()))?;
        let svg = picture::svg(&outcome).map_err(|why| work(why.to_string()))?;
        let png = picture::png(&outcome).map_err(|why| work(why.to_string()))?;
        for (ending, bytes) in
            [("md", table.into_bytes()), ("json", json.into_bytes()), ("svg", svg.into_bytes()), ("png", png)]
        {
            let file = folder.join("stability").with_extension(ending);
            image::write_atomically(&file, &bytes).map_err(|why| work(why.to_string()))?;
        }
    }
    match outcome.broken().count() {
        0 => Ok(()),
        count => Err(Failure::Work(format!("{count} rows are not as expected"))),
    }
}
