//! Interruption by Ctrl-C or a signal to terminate.
//!
//! The search looks at [`cancelled`] between batches of boxes. What does not look, such as the exact
//! check of a large proof, is ended with the process, but never while a file is being written.

use super::{print, progress, Failure, Format, Status};
use crate::files::output;
use serde::Serialize;
use std::path::Path;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread;
use std::time::{Duration, Instant};

/// How long the work may take to end by itself, in milliseconds.
static GRACE: AtomicU64 = AtomicU64::new(400);
/// The exit code of an interrupted command.
const CODE: u8 = 4;

static CANCEL: AtomicBool = AtomicBool::new(false);
static SAID: AtomicBool = AtomicBool::new(false);

/// Starts to listen. A platform without signals goes without.
pub fn listen() {
    let listening = ctrlc::set_handler(|| {
        CANCEL.store(true, Ordering::Relaxed);
        thread::sleep(Duration::from_millis(GRACE.load(Ordering::Relaxed)));
        let _no_file_is_begun = output::hold();
        say();
        std::process::exit(i32::from(CODE));
    });
    drop(listening);
}

/// The flag that is set by a signal, or [`at`] a time.
pub fn cancelled() -> &'static AtomicBool {
    &CANCEL
}

/// Whether it is set.
pub fn is_cancelled() -> bool {
    CANCEL.load(Ordering::Relaxed)
}

/// Sets [`cancelled`] at this time, for work that looks at nothing else.
pub fn at(deadline: Instant) -> Result<(), Failure> {
    let left = deadline.saturating_duration_since(Instant::now());
    if left.is_zero() {
        CANCEL.store(true, Ordering::Relaxed);
        return Ok(());
    }
    let waits = thread::Builder::new().spawn(move || {
        thread::sleep(left);
        CANCEL.store(true, Ordering::Relaxed);
    });
    waits.map(drop).map_err(|error| {
        Failure::Output(format!("--timeout: no thread can be started to keep it: {error}"))
    })
}

/// Gives the work five seconds to end by itself: for a command that still has something to write, and
/// that looks at [`cancelled`] all the time.
pub fn grant() {
    GRACE.store(5000, Ordering::Relaxed);
}

/// An answer, or its status: a signal that came before it was complete counts, whatever was found.
pub fn unless_cancelled<T>(answer: T) -> Result<T, Failure> {
    match is_cancelled() {
        true => Err(Failure::Interrupted),
        false => Ok(answer),
    }
}

/// The answer for scripts where the time was up.
#[derive(Serialize)]
struct Unfinished {
    out_of_time: bool,
    /// What `--resume` takes up.
    part: Option<String>,
}

/// Tells what a run leaves that did not end.
pub fn unfinished(
    time_is_up: bool,
    left: &str,
    part: Option<&Path>,
    format: Format,
) -> Result<Status, Failure> {
    if !time_is_up {
        if part.is_some() {
            print::diagnostic(left);
        }
        return Err(Failure::Interrupted);
    }
    print::diagnostic(&format!("the time was up: {left}"));
    if format == Format::Json {
        let part = part.map(|part| part.to_string_lossy().into_owned());
        print::json(&Unfinished { out_of_time: true, part })?;
    }
    Ok(Status::Undecided)
}

/// What an answer that is not complete says of itself, for people.
pub const PARTIAL: &str = "PARTIAL: interrupted; what stands here was found before, and holds.";

/// Says once that the command was interrupted; returns the exit code. From now on no file is begun,
/// so that the process may end under the threads that are left.
pub fn end() -> ExitCode {
    std::mem::forget(output::hold());
    say();
    ExitCode::from(CODE)
}

fn say() {
    if !SAID.swap(true, Ordering::Relaxed) {
        progress::clear();
        print::diagnostic("interrupted");
    }
}
