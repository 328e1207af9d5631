//! The page of a comparison.

use super::{
    table,
    template::{Html, fill},
    viewer::Viewer,
};
use crate::compare::{
    error::FileError,
    error_map::ErrorMap,
    plot::{self, ErrorKind},
    report::{Comparison, Report},
};

const PAGE: &str = include_str!("report.html");
const STYLE: &str = include_str!("report.css");
const SCRIPT: &str = include_str!("report.js");

/// The page. Where it would grow beyond what a browser is glad to open, it leaves out pictures and says which.
///
/// # Errors
/// [`FileError`] where a picture or a plot cannot be made.
pub fn page(comparison: &Comparison) -> Result<String, FileError> {
    let report = &comparison.report;
    let viewer = Viewer::new(comparison)?;
    Ok(fill(
        PAGE,
        &[
            ("title", Html::text(&title(report))),
            ("style", Html::trusted(STYLE)),
            ("script", Html::trusted(SCRIPT)),
            ("facts", facts(report)),
            ("table", table::table(report)),
            ("notes", notes(report, &viewer)),
            ("plots", plots(report)?),
            ("legends", legends()?),
            ("data", viewer.data()),
        ],
    ))
}

fn title(report: &Report) -> String {
    format!("{}: techniques compared", report.subject.shot)
}

/// The measurement's subject and circumstances, as terms and descriptions.
fn facts(report: &Report) -> Html {
    let [width, height] = report.size;
    let adapter = report.subject.adapter.as_ref().map_or_else(
        || "CPU".to_owned(),
        |adapter| format!("{}, {}, {}", adapter.name, adapter.api, adapter.driver),
    );
    let parameters: Vec<String> = report
        .reference
        .parameters
        .iter()
        .map(|(key, value)| format!("{key} {value}"))
        .collect();
    [
        ("Shot", report.subject.shot.clone()),
        ("Scene", report.subject.scene.clone()),
        ("Resolution", format!("{width} \u{d7} {height} pixels")),
        ("Adapter", adapter),
        (
            "Reference",
            format!("{}: {}", report.reference.technique, parameters.join(", ")),
        ),
        ("Shadow maps", floor(report)),
        ("Limit", limit(report)),
        (
            "Exposure",
            format!("{:.2} EV, all pictures", report.exposure),
        ),
        ("Measured", report.date.clone()),
        ("Command", report.subject.command.join(" ")),
        ("Version", format!("tyndall {}", env!("CARGO_PKG_VERSION"))),
    ]
    .into_iter()
    .map(|(term, fact)| {
        let (term, fact) = (Html::text(term), Html::text(&fact));
        Html::trusted(&format!("<div><dt>{term}</dt><dd>{fact}</dd></div>\n"))
    })
    .collect()
}

/// The shadow maps' own error, in words.
fn floor(report: &Report) -> String {
    report.floor.as_ref().map_or_else(
        || "the reference reads the same shadow maps".to_owned(),
        |floor| {
            format!(
                "relMAE {} against the reference",
                table::percent(floor.rel_mae)
            )
        },
    )
}

/// The limit's time, in words.
fn limit(report: &Report) -> String {
    report.limit.as_ref().map_or_else(
        || "not measured on the CPU".to_owned(),
        |limit| {
            format!(
                "{} ms: depth and shadow map read once, output written once",
                table::milliseconds(&limit.total())
            )
        },
    )
}

fn notes(report: &Report, viewer: &Viewer) -> Html {
    let notes = report
        .subject
        .left_out
        .iter()
        .cloned()
        .chain(viewer.notes());
    notes
        .map(|note| Html::trusted(&format!("<li>{}</li>\n", Html::text(&note))))
        .collect()
}

fn plots(report: &Report) -> Result<Html, FileError> {
    [ErrorKind::RelMae, ErrorKind::P99]
        .into_iter()
        .map(|kind| {
            let caption = format!(
                "{} against median time; each point is a setting",
                kind.name()
            );
            let svg = plot::error_against_time(report, kind)?;
            Ok(figure(&svg, &caption))
        })
        .collect()
}

fn legends() -> Result<Html, FileError> {
    ErrorMap::ALL
        .into_iter()
        .map(|map| {
            let sign = match map {
                ErrorMap::Magnitude => "mean over channels of |a \u{2212} b| / mean(b)",
                ErrorMap::Signed => {
                    "mean over channels of (a \u{2212} b) / mean(b); red is too bright"
                }
            };
            let caption = format!(
                "{}: {sign}; logarithmic; green is not a number",
                map.title()
            );
            Ok(figure(&plot::legend(map)?, &caption))
        })
        .collect()
}

fn figure(svg: &str, caption: &str) -> Html {
    let caption = Html::text(caption);
    Html::trusted(&format!(
        "<figure><div role=\"img\" aria-label=\"{caption}\">{svg}</div><figcaption>{caption}</figcaption></figure>\n"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::fixture;

    #[test]
    fn a_page_is_whole_escaped_and_needs_no_network() {
        let page = page(&fixture::comparison()).unwrap();
        assert!(!page.contains("{{"), "a slot is empty");
        assert!(page.contains("a &lt;shot&gt; &amp; more: techniques compared"));
        assert!(!page.contains("<shot>"));
        for word in [
            "a driver 1.0",
            "tyndall compare a.toml",
            "2026-01-01T00:00:00Z",
            "magic: there is none",
        ] {
            assert!(page.contains(word), "{word}");
        }
        // Names of XML namespaces are no requests.
        let page = page.replace("http://www.w3.org/2000/svg", "");
        for request in ["http:", "https:", "src=\"/", "url(", "@import", "<link"] {
            assert!(!page.contains(request), "{request}");
        }
    }
}
