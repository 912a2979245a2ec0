//! The prover and the exact checker in a browser: a question comes in, an answer goes out, both as
//! JSON in the module's memory.
//!
//! The page calls [`room`] for a question's bytes, writes them there, calls [`ask`], and reads
//! [`length`] bytes at [`answer`]. Every verdict is one that [`orthocert_checker::check`] accepted.

mod limit;
mod machines;
mod questions;

use std::cell::RefCell;

thread_local! {
    static QUESTION: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
    static ANSWER: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Where the `length` bytes of the next question are to be written.
#[no_mangle]
pub extern "C" fn room(length: usize) -> *mut u8 {
    QUESTION.with_borrow_mut(|question| {
        question.clear();
        question.resize(length, 0);
        question.as_mut_ptr()
    })
}

/// Answers the question that was written.
#[no_mangle]
pub extern "C" fn ask() {
    let answered = QUESTION.with_borrow(|question| questions::answered(question));
    ANSWER.with_borrow_mut(|answer| *answer = answered);
}

/// Where the answer is, until the next question.
#[no_mangle]
pub extern "C" fn answer() -> *const u8 {
    ANSWER.with_borrow(|answer| answer.as_ptr())
}

/// How many bytes it has.
#[no_mangle]
pub extern "C" fn length() -> usize {
    ANSWER.with_borrow(String::len)
}
