//! Values of options, from text. Each function says what it accepts when it refuses.

use std::time::Duration;

use antumbra::{
    image::check_size,
    render::{Method, Overlay},
    report::Exhibit,
    scene::{self, Animation, ColorBy, Course, Exposure, Finish, Tone},
    shadow::Penumbra,
};

/// Width and height in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Size {
    pub(crate) width: usize,
    pub(crate) height: usize,
}

/// A value for a parameter.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Assignment {
    pub(crate) name: String,
    pub(crate) value: f64,
}

/// A parameter that moves.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Span {
    pub(crate) name: String,
    pub(crate) from: f64,
    pub(crate) to: f64,
}

/// `a=0.05`: a name, and a number or what the formula language makes one of.
pub(crate) fn assignment(text: &str) -> Result<Assignment, String> {
    let form = || "give a name and a value, such as a=0.05".to_owned();
    let (name, value) = text.split_once('=').ok_or_else(form)?;
    let name = name.trim();
    if name.is_empty() || value.trim().is_empty() {
        return Err(form());
    }
    Ok(Assignment { name: name.to_owned(), value: scene::number(value)? })
}

/// `a=0:1`.
pub(crate) fn span(text: &str) -> Result<Span, String> {
    let form = || "give a name and two values, such as a=0:1".to_owned();
    let (name, values) = text.split_once('=').ok_or_else(form)?;
    let (from, to) = values.split_once(':').ok_or_else(form)?;
    let name = name.trim();
    if name.is_empty() || from.trim().is_empty() || to.trim().is_empty() {
        return Err(form());
    }
    let (from, to) = (scene::number(from)?, scene::number(to)?);
    if from == to {
        return Err(format!("both ends are {from}: nothing would move; --set gives a parameter one value"));
    }
    Ok(Span { name: name.to_owned(), from, to })
}

/// Frames of an animation.
pub(crate) fn frames(text: &str) -> Result<usize, String> {
    whole(text, 1, Animation::MOST)
}

/// Frames per second.
pub(crate) fn rate(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(rate) if (0.01..=100.0).contains(&rate) => Ok(rate),
        _ => Err("give a number from 0.01 to 100".to_owned()),
    }
}

/// How an animation loops.
pub(crate) fn course(text: &str) -> Result<Course, String> {
    match text {
        "back" => Ok(Course::Back),
        "around" => Ok(Course::Around),
        _ => Err("it is `back` (there and back again) or `around` (the end is the beginning)".to_owned()),
    }
}

/// `512` (a square) or `800x600`.
pub(crate) fn size(text: &str) -> Result<Size, String> {
    const FORM: &str = "give a number of pixels such as 512, or WIDTHxHEIGHT such as 800x600";
    let (width, height) = text.split_once(['x', 'X', '×']).unwrap_or((text, text));
    let side = |word: &str| -> Result<usize, String> {
        let word = word.trim();
        if word.is_empty() || !word.bytes().all(|b| b.is_ascii_digit()) {
            return Err(FORM.to_owned());
        }
        // Only digits: what does not parse is too long.
        Ok(word.parse::<usize>().unwrap_or(usize::MAX))
    };
    let (width, height) = (side(width)?, side(height)?);
    check_size([width, height]).map_err(|e| e.to_string())?;
    Ok(Size { width, height })
}

/// A whole number in `lo..=hi`.
fn whole(text: &str, lo: usize, hi: usize) -> Result<usize, String> {
    match text.parse::<usize>() {
        Ok(n) if (lo..=hi).contains(&n) => Ok(n),
        _ => Err(format!("give a whole number from {lo} to {hi}")),
    }
}

/// Columns of a sheet of pictures.
pub(crate) fn columns(text: &str) -> Result<usize, String> {
    whole(text, 1, 100)
}

/// Threads, 1 or more.
pub(crate) fn threads(text: &str) -> Result<usize, String> {
    whole(text, 1, 1024).map_err(|e| format!("{e}, or leave it out to use every processor"))
}

/// A time in seconds, more than 0.
pub(crate) fn budget(text: &str) -> Result<Duration, String> {
    let seconds = text.parse::<f64>().ok().filter(|s| *s > 0.0).and_then(|s| Duration::try_from_secs_f64(s).ok());
    seconds.ok_or_else(|| "give a number of seconds greater than 0, such as 60 or 0.5".to_owned())
}

/// Cells of the grid along each axis.
pub(crate) fn grid(text: &str) -> Result<usize, String> {
    whole(text, 1, 512)
}

/// Sub-beams along each side of the light.
pub(crate) fn sub_beams(text: &str) -> Result<usize, String> {
    whole(text, 1, 64)
}

/// A finite number greater than 0.
pub(crate) fn light_scale(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(k) if k.is_finite() && k > 0.0 => Ok(k),
        _ => Err("give a finite number greater than 0, such as 4".to_owned()),
    }
}

/// A finite distance, 0 or more.
pub(crate) fn offset(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(e) if e.is_finite() && e >= 0.0 => Ok(e),
        _ => Err("give a finite distance of 0 or more, such as 1e-4".to_owned()),
    }
}

/// A width in (0, 1], as a number or as a fraction `1/n`.
pub(crate) fn tolerance(text: &str) -> Result<f64, String> {
    let value = match text.split_once('/') {
        Some((a, b)) => a.trim().parse::<f64>().ok().zip(b.trim().parse::<f64>().ok()).map(|(a, b)| a / b),
        None => text.parse::<f64>().ok(),
    };
    match value {
        Some(t) if (1e-9..=1.0).contains(&t) => Ok(t),
        _ => Err("give a number from 1e-9 to 1, or a fraction such as 1/1024".to_owned()),
    }
}

/// An overlay by its name.
pub(crate) fn overlay(text: &str) -> Result<Overlay, String> {
    Overlay::from_name(text).ok_or_else(|| choices("overlays", text, &Overlay::ALL.map(|(_, name)| name)))
}

/// A method by its name.
pub(crate) fn method(text: &str) -> Result<Method, String> {
    Method::from_name(text).ok_or_else(|| choices("methods", text, &Method::ALL.map(|(_, name, _)| name)))
}

/// Who proves a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Device {
    Cpu,
    Gpu,
    Auto,
}

/// A device by its name.
pub(crate) fn device(text: &str) -> Result<Device, String> {
    let all = [("cpu", Device::Cpu), ("gpu", Device::Gpu), ("auto", Device::Auto)];
    let found = all.iter().find(|(name, _)| *name == text).map(|(_, device)| *device);
    found.ok_or_else(|| choices("devices", text, &all.map(|(name, _)| name)))
}

/// A way to resolve penumbrae by its name.
pub(crate) fn penumbra(text: &str) -> Result<Penumbra, String> {
    Penumbra::from_name(text).ok_or_else(|| choices("orders", text, &Penumbra::ALL.map(|(_, name)| name)))
}

/// A tone by its name.
pub(crate) fn tone(text: &str) -> Result<Tone, String> {
    by_name("tones", text, &Tone::ALL)
}

/// A finish by its name.
pub(crate) fn finish(text: &str) -> Result<Finish, String> {
    by_name("finishes", text, &Finish::ALL)
}

/// What decides colours, by its name.
pub(crate) fn color_by(text: &str) -> Result<ColorBy, String> {
    by_name("choices", text, &ColorBy::ALL)
}

/// `auto`, or a number of stops.
pub(crate) fn exposure(text: &str) -> Result<Exposure, String> {
    let message = || format!("give `auto`, or a number of stops from -{0} to {0}, such as 0.5", Exposure::MOST);
    match text.parse::<f64>() {
        _ if text == "auto" => Ok(Exposure::AUTO),
        Ok(stops) if stops.abs() <= Exposure::MOST => Ok(Exposure::Stops(stops)),
        _ => Err(message()),
    }
}

fn by_name<T: Copy>(what: &str, text: &str, all: &[(T, &'static str)]) -> Result<T, String> {
    let names: Vec<&str> = all.iter().map(|(_, name)| *name).collect();
    all.iter().find(|(_, name)| *name == text).map(|(value, _)| *value).ok_or_else(|| choices(what, text, &names))
}

/// An exhibit by its name.
pub(crate) fn exhibit(text: &str) -> Result<Exhibit, String> {
    Exhibit::from_name(text).ok_or_else(|| choices("exhibits", text, &Exhibit::ALL.map(|(_, name, _)| name)))
}

/// What there is to choose from, and what was probably meant.
fn choices(what: &str, text: &str, names: &[&str]) -> String {
    let advice = nearest(text, names).map(|name| format!("; did you mean `{name}`?")).unwrap_or_default();
    format!("the {what} are {}{advice}", names.join(", "))
}

/// The name that was probably meant, if one is near enough.
pub(crate) fn nearest<'a>(text: &str, names: &[&'a str]) -> Option<&'a str> {
    let text = text.to_lowercase();
    let near = |name: &&'a str| likeness(&text, name);
    names.iter().copied().max_by(|a, b| near(a).total_cmp(&near(b))).filter(|name| near(name) > 0.8)
}

/// How like two names are, from 0 to 1.
pub(crate) fn likeness(a: &str, b: &str) -> f64 {
    strsim::jaro_winkler(a, b)
}

/// Whether a word is a formula that begins with a minus, and no option: it goes on with a variable, a number, a bracket, a function or another minus
/// before one, and names a variable.
pub(crate) fn is_negative_formula(word: &str) -> bool {
    let Some(rest) = word.strip_prefix('-') else { return false };
    let rest = rest.trim_start();
    let name = rest.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(rest.len());
    let begins = match rest.chars().next() {
        Some('0'..='9' | '.' | '(') => true,
        Some('x' | 'y' | 'z') if name == 1 => true,
        // No option is followed by a bracket.
        _ => name > 1 && rest[name..].starts_with('('),
    };
    begins && rest.contains(['x', 'y', 'z'])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes() {
        assert_eq!(size("512"), Ok(Size { width: 512, height: 512 }));
        assert_eq!(size("800x600"), Ok(Size { width: 800, height: 600 }));
        assert_eq!(size("800 × 600"), Ok(Size { width: 800, height: 600 }));
        assert_eq!(size("65535x4096"), Ok(Size { width: 65535, height: 4096 }));
        for (bad, word) in [
            ("0", "at least 1"),
            ("512x0", "at least 1"),
            ("1000000000", "at most 65535"),
            ("99999999999999999999999", "at most 65535"),
            ("65535x65535", "altogether"),
            ("", "800x600"),
            ("x", "800x600"),
            ("512x", "800x600"),
            ("-5", "800x600"),
            ("+5", "800x600"),
            ("5.5", "800x600"),
            ("1x2x3", "800x600"),
            ("big", "800x600"),
        ] {
            let message = size(bad).expect_err(bad);
            assert!(message.contains(word), "{bad}: {message}");
        }
    }

    #[test]
    fn counts_and_distances() {
        assert_eq!(threads("2"), Ok(2));
        assert_eq!(grid("32"), Ok(32));
        assert_eq!(sub_beams("7"), Ok(7));
        assert_eq!(light_scale("4"), Ok(4.0));
        assert_eq!(offset("0"), Ok(0.0));
        for bad in ["-2", "0", "1.5", "", "two", "99999999999999999999"] {
            assert!(threads(bad).is_err() && grid(bad).is_err() && sub_beams(bad).is_err(), "{bad}");
        }
        for bad in ["NaN", "inf", "-inf", "-1", "", "1e999", "four"] {
            assert!(light_scale(bad).is_err() && offset(bad).is_err(), "{bad}");
        }
        assert!(light_scale("0").is_err());
    }

    #[test]
    fn names_that_were_meant() {
        assert_eq!(nearest("orthocirle", &["chubs", "orthocircle"]), Some("orthocircle"));
        assert_eq!(nearest("Chubs", &["chubs", "orthocircle"]), Some("chubs"));
        assert_eq!(nearest("teapot", &["chubs", "orthocircle"]), None);
        assert_eq!(nearest("x", &[]), None);
        assert!(exhibit("fig8").expect_err("no such exhibit").contains("table1"));
        assert!(method("papr").expect_err("no such method").contains("did you mean `paper`?"));
    }

    #[test]
    fn formulas_that_begin_with_a_minus() {
        for formula in ["-x^2 + 1", "-(x + y)", "- 2 z", "-.5x", "-3 x = y", "-sin(x) + y", "-exp(y)"] {
            assert!(is_negative_formula(formula), "{formula}");
        }
        for other in
            ["-o", "-ox.png", "-q", "--size", "-1", "-3,4,5", "-h", "-V", "x - y", "", "-", "--", "-sz", "-ox=y"]
        {
            assert!(!is_negative_formula(other), "{other}");
        }
    }
}
