//! The real window, on a display that nobody sees: started, typed into, dragged, looked at, closed.
//!
//! Needs `Xvfb`, and a driver that draws in software or not; says loudly that it is skipped where there is none, and fails instead where
//! `ANTUMBRA_WINDOW_REQUIRED` is set. With `ANTUMBRA_WINDOW_SHOTS=DIR` it leaves what it saw there.
#![cfg(target_os = "linux")]

use std::{
    collections::BTreeSet,
    error::Error,
    io::{BufRead, BufReader},
    ops::Range,
    path::Path,
    process::{Child, Command, Stdio},
    thread::sleep,
    time::{Duration, Instant},
};

use x11rb::{
    connection::Connection,
    protocol::{
        xproto::{
            BUTTON_PRESS_EVENT, BUTTON_RELEASE_EVENT, ClientMessageEvent, ConnectionExt as _, EventMask, ImageFormat,
            InputFocus, KEY_PRESS_EVENT, KEY_RELEASE_EVENT, MOTION_NOTIFY_EVENT, Window,
        },
        xtest::ConnectionExt as _,
    },
    rust_connection::RustConnection,
};

type Outcome<T> = Result<T, Box<dyn Error>>;

/// Ended when it is dropped.
struct Process(Child);

impl Drop for Process {
    fn drop(&mut self) {
        // Both fail where it has ended already.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Size of the screen.
const SCREEN: [u16; 2] = [1280, 820];
/// Where the picture is, above what is told of a pixel, and where errors begin in the left panel.
const PICTURE: (Range<usize>, Range<usize>) = (380..970, 90..600);
const LEFT: (Range<usize>, Range<usize>) = (10..330, 138..186);
const LONG: Duration = Duration::from_secs(120);

/// A display that nobody sees; `None` where there is no Xvfb.
fn display(more: &[&str]) -> Outcome<Option<(Process, String)>> {
    let [w, h] = SCREEN;
    let screen = format!("{w}x{h}x24");
    let mut command = Command::new("Xvfb");
    command
        .args(["-displayfd", "1", "-screen", "0", &screen, "-nolisten", "tcp"])
        .args(more)
        .stdout(Stdio::piped())
        .stderr(Stdio::null());
    let Ok(mut child) = command.spawn() else { return Ok(None) };
    let out = child.stdout.take().ok_or("its output is piped")?;
    let process = Process(child);
    let mut number = String::new();
    BufReader::new(out).read_line(&mut number)?;
    if number.trim().is_empty() {
        return Err("Xvfb ended without a display".into());
    }
    Ok(Some((process, format!(":{}", number.trim()))))
}

/// A hand and an eye.
struct Screen {
    x: RustConnection,
    root: Window,
    /// For each key its symbols, the second with shift.
    keys: Vec<(u8, Vec<u32>)>,
}

/// Blue, green, red and nothing of each pixel.
type Shot = Vec<u8>;

impl Screen {
    fn open(display: &str) -> Outcome<Self> {
        let (x, number) = RustConnection::connect(Some(display))?;
        let root = x.setup().roots[number].root;
        let (first, last) = (x.setup().min_keycode, x.setup().max_keycode);
        let map = x.get_keyboard_mapping(first, last - first + 1)?.reply()?;
        let per = usize::from(map.keysyms_per_keycode);
        let keys =
            map.keysyms.chunks(per).enumerate().map(|(k, symbols)| (first + k as u8, symbols.to_vec())).collect();
        Ok(Self { x, root, keys })
    }

    /// The program's window, when it is there.
    fn window(&self) -> Outcome<Option<Window>> {
        for window in self.x.query_tree(self.root)?.reply()?.children {
            let name = self.x.intern_atom(false, b"WM_NAME")?.reply()?.atom;
            let title = self.x.get_property(false, window, name, x11rb::NONE, 0, 100)?.reply()?;
            if title.value.starts_with(b"Antumbra") {
                return Ok(Some(window));
            }
        }
        Ok(None)
    }

    fn look(&self) -> Outcome<Shot> {
        let [w, h] = SCREEN;
        Ok(self.x.get_image(ImageFormat::Z_PIXMAP, self.root, 0, 0, w, h, u32::MAX)?.reply()?.data)
    }

    fn event(&self, kind: u8, detail: u8, x: i16, y: i16) -> Outcome<()> {
        self.x.xtest_fake_input(kind, detail, x11rb::CURRENT_TIME, self.root, x, y, 0)?.check()?;
        // A hand is not faster.
        sleep(Duration::from_millis(12));
        Ok(())
    }

    fn key(&self, symbol: u32, with: Option<u32>) -> Outcome<()> {
        let code = |symbol: u32| {
            let place = |symbols: &Vec<u32>| symbols.iter().take(2).position(|s| *s == symbol);
            self.keys.iter().find_map(|(code, symbols)| Some((*code, place(symbols)?))).ok_or("no key has that symbol")
        };
        let (key, shifted) = code(symbol)?;
        let (shift, _) = code(0xffe1)?;
        let with = with.map(code).transpose()?.map(|(code, _)| code).or((shifted == 1).then_some(shift));
        for kind in [KEY_PRESS_EVENT, KEY_RELEASE_EVENT] {
            if let Some(with) = with.filter(|_| kind == KEY_PRESS_EVENT) {
                self.event(kind, with, 0, 0)?;
            }
            self.event(kind, key, 0, 0)?;
            if let Some(with) = with.filter(|_| kind == KEY_RELEASE_EVENT) {
                self.event(kind, with, 0, 0)?;
            }
        }
        Ok(())
    }

    /// Writes over what is in the field of the formula.
    fn type_formula(&self, text: &str) -> Outcome<()> {
        self.click([150, 100])?;
        // Keys belong to the field as soon as it has its bright border.
        let border = (20..300, 78..84);
        let bright = |shot: &Shot| region(shot, &border).iter().filter(|c| c.iter().all(|x| *x > 200)).count() > 100;
        let begun = Instant::now();
        while !bright(&self.look()?) {
            if begun.elapsed() > LONG {
                return Err("the field of the formula does not take the keys".into());
            }
            sleep(Duration::from_millis(100));
        }
        self.key('a'.into(), Some(0xffe3))?;
        text.chars().try_for_each(|c| self.key(c.into(), None))
    }

    fn click(&self, at: [i16; 2]) -> Outcome<()> {
        self.event(MOTION_NOTIFY_EVENT, 0, at[0], at[1])?;
        self.event(BUTTON_PRESS_EVENT, 1, 0, 0)?;
        self.event(BUTTON_RELEASE_EVENT, 1, 0, 0)
    }

    /// Drags, and holds on until the picture follows: a window that draws slowly sees a drag only if there is a frame in it.
    fn drag(&self, from: [i16; 2], to: [i16; 2]) -> Outcome<()> {
        const STEPS: i16 = 12;
        let before = self.look()?;
        self.event(MOTION_NOTIFY_EVENT, 0, from[0], from[1])?;
        self.event(BUTTON_PRESS_EVENT, 1, 0, 0)?;
        let begun = Instant::now();
        while difference(&before, &self.look()?) < 0.05 {
            if begun.elapsed() > LONG {
                return Err("the picture does not follow the hand".into());
            }
            for k in 1..=STEPS {
                let at = |axis: usize| from[axis] + (to[axis] - from[axis]) * k / STEPS;
                self.event(MOTION_NOTIFY_EVENT, 0, at(0), at(1))?;
            }
            sleep(Duration::from_millis(300));
        }
        self.event(BUTTON_RELEASE_EVENT, 1, 0, 0)
    }

    /// What is seen as soon as it is so and has not changed for a while.
    fn until(&self, what: &str, so: impl Fn(&Shot) -> bool) -> Outcome<Shot> {
        let begun = Instant::now();
        let (mut last, mut still) = (self.look()?, 0);
        while begun.elapsed() < LONG {
            sleep(Duration::from_millis(250));
            let now = self.look()?;
            still = if region(&now, &PICTURE) == region(&last, &PICTURE) { still + 1 } else { 0 };
            last = now;
            if still >= 4 && so(&last) {
                return Ok(last);
            }
        }
        save(&last, "failed");
        Err(format!("{what} did not come").into())
    }

    fn close(&self, window: Window) -> Outcome<()> {
        let atom = |name: &[u8]| -> Outcome<u32> { Ok(self.x.intern_atom(false, name)?.reply()?.atom) };
        let data = [atom(b"WM_DELETE_WINDOW")?, 0, 0, 0, 0];
        let message = ClientMessageEvent::new(32, window, atom(b"WM_PROTOCOLS")?, data);
        Ok(self.x.send_event(false, window, EventMask::NO_EVENT, message)?.check()?)
    }
}

/// Colours of a part of a shot.
fn region(shot: &Shot, (columns, rows): &(Range<usize>, Range<usize>)) -> Vec<[u8; 3]> {
    let width = usize::from(SCREEN[0]);
    let pixel = |row: usize, column: usize| {
        let at = 4 * (row * width + column);
        [shot[at + 2], shot[at + 1], shot[at]]
    };
    rows.clone().flat_map(|row| columns.clone().map(move |column| (row, column))).map(|(r, c)| pixel(r, c)).collect()
}

/// Different colours, coarsely.
fn colours(shot: &Shot) -> usize {
    region(shot, &PICTURE).into_iter().map(|c| c.map(|x| x >> 3)).collect::<BTreeSet<_>>().len()
}

/// Share of the picture in which red and blue differ as on the default surfaces, clay and slate.
fn surface(shot: &Shot) -> f64 {
    let all = region(shot, &PICTURE);
    all.iter().filter(|[r, _, b]| r.abs_diff(*b) > 40).count() as f64 / all.len() as f64
}

/// Share of the pixels of the picture that differ clearly.
fn difference(a: &Shot, b: &Shot) -> f64 {
    let (a, b) = (region(a, &PICTURE), region(b, &PICTURE));
    let differs = |(a, b): &(&[u8; 3], &[u8; 3])| (0..3).any(|k| a[k].abs_diff(b[k]) > 24);
    a.iter().zip(&b).filter(differs).count() as f64 / a.len() as f64
}

/// Whether the bar below is full and green: then nothing changes any more but by a hand.
fn finished(shot: &Shot) -> bool {
    let end = region(shot, &(140..156, 800..804));
    end.iter().all(|c| c.iter().zip([142, 198, 142]).all(|(a, b)| a.abs_diff(b) < 12))
}

/// Whether something is written in the colour of errors.
fn complains(shot: &Shot) -> bool {
    // The brightest parts of the letters.
    let bad = |c: &[u8; 3]| c[0] > 190 && c[1].abs_diff(c[2]) < 30 && c[0].abs_diff(c[1]) > 80;
    region(shot, &LEFT).iter().filter(|c| bad(c)).count() > 30
}

fn save(shot: &Shot, name: &str) {
    let Some(folder) = std::env::var_os("ANTUMBRA_WINDOW_SHOTS") else { return };
    let [w, h] = SCREEN.map(u32::from);
    let file = std::fs::File::create(Path::new(&folder).join(format!("{name}.png"))).expect("the folder takes files");
    let mut encoder = png::Encoder::new(file, w, h);
    encoder.set_color(png::ColorType::Rgb);
    let rgb: Vec<u8> = shot.chunks(4).flat_map(|c| [c[2], c[1], c[0]]).collect();
    encoder.write_header().and_then(|mut out| out.write_image_data(&rgb)).expect("it can be encoded");
}

fn view(display: Option<&str>, arguments: &[&str]) -> Command {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("antumbra"));
    command
        .arg("view")
        .args(arguments)
        .stderr(Stdio::piped())
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("WAYLAND_SOCKET");
    match display {
        Some(display) => command.env("DISPLAY", display),
        None => command.env_remove("DISPLAY"),
    };
    command
}

#[test]
fn without_a_display_it_says_so() {
    let output = view(None, &["chubs"]).output().unwrap();
    let words = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{words}");
    assert!(words.contains("there is no display") && words.contains("antumbra render"), "{words}");
    let output = view(Some(":4711"), &["chubs"]).output().unwrap();
    let words = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{words}");
    assert!(words.contains("there is no display: ") && !words.contains(".rs:"), "{words}");
    let output = view(None, &["x^2 + $"]).output().unwrap();
    assert_eq!(output.status.code(), Some(2), "a bad formula is found first");
}

/// The display, unless there is no Xvfb and none is required.
fn hidden(more: &[&str]) -> Option<(Process, String)> {
    let found = display(more).unwrap();
    let required = std::env::var_os("ANTUMBRA_WINDOW_REQUIRED").is_some();
    assert!(found.is_some() || !required, "ANTUMBRA_WINDOW_REQUIRED is set, and there is no Xvfb");
    if found.is_none() {
        eprintln!("SKIPPED: there is no Xvfb, the window is not looked at");
    }
    found
}

/// Hides the drivers for Vulkan, by the two names that its loader knows for where they are.
fn without_vulkan(command: &mut Command) -> &mut Command {
    ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"].iter().fold(command, |command, name| command.env(name, "/no/driver.json"))
}

/// Lets a hand work in the window of a command and gives what that says when it is closed.
fn look_at(display: &str, command: &mut Command, whole: bool) -> String {
    let mut child = Process(command.spawn().unwrap());
    let ended = session(display, whole);
    if ended.is_err() {
        let _ = child.0.kill();
    }
    let status = child.0.wait().unwrap();
    let mut words = String::new();
    std::io::Read::read_to_string(child.0.stderr.as_mut().unwrap(), &mut words).unwrap();
    if let Err(error) = ended {
        panic!("{error}\n{words}");
    }
    assert!(status.success() && words.contains("frames of the window"), "{status}: {words}");
    words
}

#[test]
fn a_hand_types_and_drags_and_sees_the_surface_move() {
    let Some((_server, display)) = hidden(&[]) else { return };
    let words = look_at(&display, &mut view(Some(&display), &["chubs", "--timings"]), true);
    println!("by default: {}", words.trim());
    let words = look_at(&display, &mut view(Some(&display), &["chubs", "--timings", "--opengl"]), false);
    println!("--opengl: {}", words.trim());
    assert!(words.contains("drawn with OpenGL"), "{words}");
}

#[test]
fn where_wgpu_has_no_adapter_opengl_draws_the_window() {
    let Some((_server, display)) = hidden(&[]) else { return };
    let words = look_at(&display, without_vulkan(&mut view(Some(&display), &["chubs", "--timings"])), false);
    println!("without Vulkan: {}", words.trim());
    assert!(words.contains("drawn with OpenGL"), "{words}");
}

/// Neither Vulkan nor OpenGL: the display has no GLX, and EGL and Mesa find no drivers.
#[test]
fn where_nothing_draws_it_says_so() {
    let Some((_server, display)) = hidden(&["-extension", "GLX"]) else { return };
    let mut command = view(Some(&display), &["chubs"]);
    without_vulkan(&mut command)
        .env("__EGL_VENDOR_LIBRARY_FILENAMES", "/no/driver.json")
        .env("LIBGL_DRIVERS_PATH", "/no");
    let mut child = Process(command.spawn().unwrap());
    let begun = Instant::now();
    let status = loop {
        if let Some(status) = child.0.try_wait().unwrap() {
            break status;
        }
        assert!(begun.elapsed() < LONG, "it neither draws nor ends");
        sleep(Duration::from_millis(100));
    };
    let mut words = String::new();
    std::io::Read::read_to_string(child.0.stderr.as_mut().unwrap(), &mut words).unwrap();
    assert_eq!(status.code(), Some(1), "{words}");
    for part in ["error: the window cannot be drawn: there is no adapter but OpenGL's", "Mesa", "antumbra render"] {
        assert!(words.contains(part), "{part}: {words}");
    }
    assert!(!words.contains("panicked"), "{words}");
}

/// Everything that a hand does; the short session only looks and drags.
fn session(display: &str, whole: bool) -> Outcome<()> {
    let screen = Screen::open(display)?;
    let begun = Instant::now();
    let window = loop {
        if let Some(window) = screen.window()? {
            break window;
        }
        if begun.elapsed() > LONG {
            return Err("there is no window".into());
        }
        sleep(Duration::from_millis(100));
    };
    let rich = |shot: &Shot| colours(shot) > 60 && surface(shot) > 0.05;
    let first = screen.until("the first picture", |shot| rich(shot) && finished(shot))?;
    screen.x.set_input_focus(InputFocus::POINTER_ROOT, window, x11rb::CURRENT_TIME)?.check()?;
    screen.drag([600, 400], [760, 360])?;
    let turned =
        screen.until("another side of it", |shot| rich(shot) && finished(shot) && difference(&first, shot) > 0.05)?;
    if whole {
        save(&first, "first");
        save(&turned, "turned");
        let mut before = turned.clone();
        for (key, name) in [('1', "verdict"), ('2', "shadow"), ('3', "cost"), ('4', "width")] {
            screen.key(key.into(), None)?;
            let shot = screen.until(name, |shot| difference(&before, shot) > 0.05)?;
            save(&shot, name);
            before = shot;
        }
        screen.key('0'.into(), None)?;
        screen.until("the colours", |shot| difference(&turned, shot) < 0.02)?;
        screen.type_formula("x^2+y^2/4+z^2=1")?;
        let typed = screen.until("the other surface", |shot| rich(shot) && difference(&turned, shot) > 0.05)?;
        save(&typed, "typed");
        assert!(!complains(&typed), "a good formula is no error");
        // Behind what is there: on the way to another formula there would be good ones.
        screen.key('$'.into(), None)?;
        let bad = screen.until("the error", complains)?;
        save(&bad, "bad");
        assert!(difference(&typed, &bad) < 0.02, "the last good picture stays");
    }
    screen.close(window)
}
