//! What JavaScript calls.
//!
//! A call that takes a text finds it in the input: JavaScript asks for room ([`input`]) and writes there. A call that returns a text or
//! bytes leaves them in the output and returns where; [`output_length`] tells how many. Both stay until the next call. No pointer is
//! followed here: the host writes into memory that is all its own to write.
#![expect(
    unsafe_code,
    reason = "names of exports and imports are promises that no compiler can check; there is no such block"
)]
use crate::Studio;
use std::cell::RefCell;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

#[link(wasm_import_module = "page")]
unsafe extern "C" {
    /// Milliseconds since some moment: `performance.now()`.
    safe fn now() -> f64;
}

fn clock() -> Duration {
    Duration::try_from_secs_f64(now() / 1e3).unwrap_or_default()
}

static PANIC: Mutex<String> = Mutex::new(String::new());

thread_local! {
    static STUDIO: RefCell<Studio> = RefCell::new(Studio::with_clock(clock));
    static INPUT: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
    static OUTPUT: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
}

/// The text that JavaScript has written.
fn text() -> String {
    INPUT.with_borrow(|bytes| String::from_utf8_lossy(bytes).into_owned())
}

/// Leaves bytes for JavaScript.
fn leave(bytes: impl Into<Vec<u8>>) -> *const u8 {
    OUTPUT.with_borrow_mut(|output| {
        *output = bytes.into();
        output.as_ptr()
    })
}

fn ask<T>(question: impl FnOnce(&Studio) -> T) -> T {
    STUDIO.with_borrow(question)
}

/// To be called once, before everything else.
#[unsafe(no_mangle)]
extern "C" fn begin() {
    std::panic::set_hook(Box::new(|info| {
        *PANIC.lock().unwrap_or_else(PoisonError::into_inner) = info.to_string();
    }));
}

/// Room for a text of so many bytes.
#[unsafe(no_mangle)]
extern "C" fn input(length: usize) -> *const u8 {
    INPUT.with_borrow_mut(|bytes| {
        bytes.clear();
        bytes.resize(length, 0);
        bytes.as_ptr()
    })
}

/// Bytes of the last output.
#[unsafe(no_mangle)]
extern "C" fn output_length() -> usize {
    OUTPUT.with_borrow(Vec::len)
}

/// What a panic said, after a trap.
#[unsafe(no_mangle)]
extern "C" fn panic_message() -> *const u8 {
    leave(PANIC.lock().unwrap_or_else(PoisonError::into_inner).clone())
}

/// [`Studio::gallery`].
#[unsafe(no_mangle)]
extern "C" fn gallery() -> *const u8 {
    leave(ask(Studio::gallery))
}

/// [`Studio::open`] of the input.
#[unsafe(no_mangle)]
extern "C" fn open() -> *const u8 {
    leave(STUDIO.with_borrow_mut(|studio| studio.open(&text())))
}

/// [`Studio::gpu_open`] of the input.
#[unsafe(no_mangle)]
extern "C" fn gpu_open() -> *const u8 {
    leave(STUDIO.with_borrow_mut(|studio| studio.gpu_open(&text())))
}

/// [`Studio::gpu_begin`].
#[unsafe(no_mangle)]
extern "C" fn gpu_begin() -> *const u8 {
    leave(STUDIO.with_borrow_mut(Studio::gpu_begin))
}

/// [`Studio::gpu_step`].
#[unsafe(no_mangle)]
extern "C" fn gpu_step() -> *const u8 {
    leave(STUDIO.with_borrow_mut(Studio::gpu_step))
}

/// [`Studio::gpu_answer`] for a ticket: the bytes in the input, or the text there that says what failed.
#[unsafe(no_mangle)]
extern "C" fn gpu_answer(ticket: u32, failed: u32) {
    let answer = if failed == 0 { Ok(INPUT.take()) } else { Err(text()) };
    STUDIO.with_borrow_mut(|studio| studio.gpu_answer(ticket, answer));
}

/// [`Studio::gpu_leave`].
#[unsafe(no_mangle)]
extern "C" fn gpu_leave() {
    STUDIO.with_borrow_mut(Studio::gpu_leave);
}

/// [`Studio::refine`] for so many milliseconds; 1 where it is finished.
#[unsafe(no_mangle)]
extern "C" fn refine(milliseconds: u32) -> u32 {
    u32::from(STUDIO.with_borrow_mut(|studio| studio.refine(Duration::from_millis(milliseconds.into()))))
}

/// [`Studio::state`].
#[unsafe(no_mangle)]
extern "C" fn state() -> *const u8 {
    leave(ask(Studio::state))
}

/// [`Studio::join`] of the bytes in the input.
#[unsafe(no_mangle)]
extern "C" fn join() -> *const u8 {
    leave(INPUT.with_borrow(|bytes| STUDIO.with_borrow_mut(|studio| studio.join(bytes))))
}

/// [`Studio::report`].
#[unsafe(no_mangle)]
extern "C" fn report() -> *const u8 {
    leave(ask(Studio::report))
}

/// [`Studio::pixels`], of the overlay that the input names.
#[unsafe(no_mangle)]
extern "C" fn pixels(lit: u32) -> *const u8 {
    leave(ask(|studio| studio.pixels(&text(), lit != 0)))
}

/// [`Studio::legend`] of the overlay that the input names.
#[unsafe(no_mangle)]
extern "C" fn legend() -> *const u8 {
    leave(ask(|studio| studio.legend(&text())))
}

/// [`Studio::pixel`].
#[unsafe(no_mangle)]
extern "C" fn pixel(column: usize, row: usize) -> *const u8 {
    leave(ask(|studio| studio.pixel(column, row)))
}

/// [`Studio::png`], of the overlay that the input names.
#[unsafe(no_mangle)]
extern "C" fn png() -> *const u8 {
    leave(ask(|studio| studio.png(&text())))
}

/// [`Studio::planes`].
#[unsafe(no_mangle)]
extern "C" fn planes() -> *const u8 {
    leave(ask(Studio::planes))
}

/// [`Studio::npy`] of the plane that the input names.
#[unsafe(no_mangle)]
extern "C" fn npy() -> *const u8 {
    leave(ask(|studio| studio.npy(&text())))
}
