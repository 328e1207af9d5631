//! Holds back what drivers write to standard error while nothing is wrong.
//!
//! Drivers and the layers between write there as they please, even where all is well: Mesa's layer that chooses a device asks
//! for a desktop, and says `error:` where there is none.

#[cfg(unix)]
use std::{
    fs::File,
    io::{self, Read, Seek},
    os::fd::OwnedFd,
    sync::{Mutex, PoisonError},
};

/// Held by who leads standard error away: two at once would lead it back to each other's file.
#[cfg(unix)]
static TURN: Mutex<()> = Mutex::new(());

/// Runs `action`; what is written to standard error meanwhile, by whichever code of this process, is dropped if it succeeds.
/// Each line of it is printed behind `driver: ` where the action fails or panics.
#[cfg(unix)]
pub(super) fn quiet_unless_it_fails<T, E>(action: impl FnOnce() -> Result<T, E>) -> Result<T, E> {
    let _turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
    // Without a temporary file the noise is what it was, and no reason to fail.
    let held = HeldBack::begin().ok();
    let result = action();
    if let (Ok(_), Some(held)) = (&result, &held) {
        // A file that cannot be emptied leaves the noise what it was.
        let _ = held.said.set_len(0);
    }
    result
}

/// Runs `action`; elsewhere drivers are known for no noise.
#[cfg(not(unix))]
pub(super) fn quiet_unless_it_fails<T, E>(action: impl FnOnce() -> Result<T, E>) -> Result<T, E> {
    action()
}

/// Standard error, led into a file until this is dropped, and what was said there is printed.
#[cfg(unix)]
struct HeldBack {
    stderr: OwnedFd,
    said: File,
}

#[cfg(unix)]
impl HeldBack {
    fn begin() -> io::Result<Self> {
        let held = Self {
            stderr: rustix::io::dup(io::stderr())?,
            said: tempfile::tempfile()?,
        };
        rustix::stdio::dup2_stderr(&held.said)?;
        Ok(held)
    }

    fn said(&mut self) -> io::Result<String> {
        let mut bytes = Vec::new();
        self.said.rewind()?;
        self.said.read_to_end(&mut bytes)?;
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    }
}

#[cfg(unix)]
impl Drop for HeldBack {
    fn drop(&mut self) {
        // Nobody can be told that standard error is gone.
        let _ = rustix::stdio::dup2_stderr(&self.stderr);
        for line in self.said().unwrap_or_default().lines() {
            eprintln!("driver: {line}");
        }
    }
}
