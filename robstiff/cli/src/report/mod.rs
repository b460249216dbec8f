//! `report.html`: one page that needs nothing beside it.
//!
//! No scripts, no network; a style sheet that serves light and dark screens and
//! paper, and figures that can be read without colour.

mod arm;
pub mod base64;
pub mod content;
mod figure;
pub mod html;
mod scatter;
mod sections;
pub mod svg;
pub mod terms;
#[cfg(test)]
mod tests;
mod triage;

use content::Report;
use html::{escape, text};

/// How pages look.
pub const STYLE: &str = include_str!("style.css");

/// The colours of what a path is coloured by.
pub const SHADES: &str = include_str!("shades.css");

/// The page. Figures and tables say µm where other texts say um.
pub fn html(report: &Report) -> String {
    let body = [
        heading(report),
        triage::section(report),
        sections::errors(report),
        sections::effects(report),
        sections::suspected(report),
        sections::unexplained(report),
        sections::doubts(report),
        sections::next(report),
        sections::residuals(report),
        sections::compliances(report),
        sections::search(report),
        sections::origins(report),
    ]
    .concat();
    html::page(&format!("{}: what the model lacks", report.robot), STYLE, &body, "")
}

fn heading(report: &Report) -> String {
    let above = if report.campaign.is_empty() {
        "Elastostatic model against measurements".to_owned()
    } else {
        format!("Elastostatic model against measurements: {}", report.campaign)
    };
    let mut page = format!("<header>\n{}{}", text("p", &above), text("h1", &report.robot));
    if !report.description.is_empty() {
        page += &text("p", &report.description);
    }
    page += "</header>\n";
    let class = if report.conclusive { "finding" } else { "finding open" };
    let summary: String = report.summary.iter().map(|sentence| text("p", &micro(sentence))).collect();
    page + &format!(
        "<section class=\"{class}\">\n<p class=\"headline\">{}.</p>\n{summary}<p><span class=\"verdict\">verdict: {}</span></p>\n</section>\n",
        escape(&micro(&report.headline)),
        escape(&report.verdict)
    )
}

/// Units as print writes them, and numbers on the line of what they belong to.
fn micro(text: &str) -> String {
    text.replace(" um", "\u{a0}µm")
        .replace(" urad", "\u{a0}µrad")
        .replace("p < ", "p\u{a0}<\u{a0}")
        .replace("p = ", "p\u{a0}=\u{a0}")
}
