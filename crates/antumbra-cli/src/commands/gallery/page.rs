//! The page that shows the pictures: one file, nothing to load.

use base64::{Engine, engine::general_purpose::STANDARD};
use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::{Drawn, counts};

const STYLE: &str = include_str!("page.css");

/// The page as text. Light or dark as the reader's system is; one column on a telephone.
pub(super) fn page(drawn: &[Drawn]) -> String {
    let undecided: u64 = drawn.iter().map(|d| d.stats.undecided()).sum();
    let pixels: usize = drawn.iter().map(|d| d.stats.width * d.stats.height).sum();
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { "Antumbra: gallery" }
                style { (PreEscaped(STYLE)) }
            }
            body {
                header {
                    h1 { "Gallery" }
                    p {
                        (drawn.len()) " surfaces, drawn by Antumbra " (env!("CARGO_PKG_VERSION")) ". Of " (pixels)
                        " pixels, " (undecided) " are undecided (violet); what all others show is proved. Colours are not."
                    }
                }
                main { @for d in drawn { (card(d)) } }
            }
        }
    }
    .into_string()
}

fn card(d: &Drawn) -> Markup {
    let about = d.scene.about.clone().unwrap_or_default();
    let (width, height) = (d.stats.width, d.stats.height);
    let source = format!("data:image/png;base64,{}", STANDARD.encode(&d.png));
    html! {
        article id=(d.name) {
            img src=(source) width=(width) height=(height) alt=(d.scene.title) loading="lazy";
            h2 { (d.scene.title) " " code { (d.name) } }
            @if !about.credit().is_empty() { p class="credit" { (about.credit()) } }
            @for object in &d.scene.objects { pre { (object.text.trim()) } }
            @if let Some(history) = &about.history { p { (history) } }
            @if let Some(source) = &about.source { p class="source" { (source) } }
            p class="counts" { (counts(&d.stats)) }
        }
    }
}
