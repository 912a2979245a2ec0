//! Interruption by Ctrl-C or a signal to terminate.
//!
//! The search looks at [`cancelled`] between batches of boxes. What does not look, such as the exact
//! check of a large proof, is ended with the process, but never while a file is being written.

use super::print;
use orthocert::output;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

/// How long the work may take to end by itself.
const GRACE: Duration = Duration::from_millis(400);
/// The exit code of an interrupted command.
const CODE: u8 = 4;

static CANCEL: AtomicBool = AtomicBool::new(false);
static SAID: AtomicBool = AtomicBool::new(false);

/// Starts to listen. A platform without signals goes without.
pub fn listen() {
    let listening = ctrlc::set_handler(|| {
        CANCEL.store(true, Ordering::Relaxed);
        thread::sleep(GRACE);
        let _no_file_is_begun = output::hold();
        say();
        std::process::exit(i32::from(CODE));
    });
    drop(listening);
}

/// The flag that is set by a signal.
pub fn cancelled() -> &'static AtomicBool {
    &CANCEL
}

/// Says once that the command was interrupted; returns the exit code.
pub fn end() -> ExitCode {
    say();
    ExitCode::from(CODE)
}

fn say() {
    if !SAID.swap(true, Ordering::Relaxed) {
        print::diagnostic("interrupted");
    }
}
