//! The order of endings, and lists of them.

use super::{counts, worst, Batch, Ending, Entry};

#[test]
fn the_worst_exit_code_wins() {
    // 4, then 2, 5, 1, 3, 0.
    let order = [
        Ending::NotRun,
        Ending::NotFinished,
        Ending::BadInput,
        Ending::Rejected,
        Ending::Refuted,
        Ending::Undecided,
        Ending::Certified,
    ];
    assert_eq!(order.map(Ending::code), [4, 4, 2, 5, 1, 3, 0]);
    for (i, one) in order.iter().enumerate() {
        for other in &order[i..] {
            assert_eq!(worst([*one, *other]), one.code());
            assert_eq!(worst([*other, *one]), one.code());
        }
    }
    assert_eq!(worst([]), 0);
}

#[test]
fn an_interrupted_batch_could_not_finish() {
    let entry = Entry::without_verdict("a.toml".into(), Ending::Certified, String::new());
    assert_eq!(Batch::new(vec![entry.clone()], false, 0.0).exit_code, 0);
    assert_eq!(Batch::new(vec![entry], true, 0.0).exit_code, 4);
}

#[test]
fn only_what_occurs_is_counted() {
    let endings = [Ending::Refuted, Ending::Certified, Ending::Refuted];
    assert_eq!(counts(endings), "1 certified, 2 refuted");
}
