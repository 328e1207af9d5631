//! Tests that cannot run where they are say so aloud, and are counted.

use std::io::Write;
use std::sync::atomic::{AtomicUsize, Ordering};

static SKIPPED: AtomicUsize = AtomicUsize::new(0);

/// Says on standard error that `what` is skipped, and why, with a count of the skips in this program.
///
/// It writes past the test runner's capture: a test that passes because it was skipped must be seen.
pub fn skip(what: &str, why: &str) {
    announce(&mut std::io::stderr(), &SKIPPED, what, why);
}

fn announce(out: &mut impl Write, counter: &AtomicUsize, what: &str, why: &str) {
    let count = counter.fetch_add(1, Ordering::Relaxed) + 1;
    // A closed standard error is no reason to fail.
    let _ = writeln!(out, "skipped: {what}: {why} (skip {count} of this program)");
}

/// True where the environment says that this is a continuous integration run (`CI`, neither empty, `0` nor `false`):
/// nothing that can be installed may be missing there.
pub fn in_ci() -> bool {
    std::env::var("CI").is_ok_and(|value| is_set(&value))
}

fn is_set(value: &str) -> bool {
    !matches!(value.to_ascii_lowercase().as_str(), "" | "0" | "false")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn skips_are_said_and_counted() {
        let (mut out, counter) = (Vec::new(), AtomicUsize::new(0));
        announce(&mut out, &counter, "a test", "no driver");
        announce(&mut out, &counter, "another", "no files");
        assert_eq!(
            String::from_utf8(out).unwrap(),
            "skipped: a test: no driver (skip 1 of this program)\n\
             skipped: another: no files (skip 2 of this program)\n"
        );
    }

    #[test]
    fn switches_are_read_as_people_write_them() {
        for (value, set) in [
            ("true", true),
            ("1", true),
            ("", false),
            ("0", false),
            ("False", false),
        ] {
            assert_eq!(is_set(value), set, "{value:?}");
        }
    }
}
