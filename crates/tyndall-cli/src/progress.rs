//! Progress, shown while people wait: bars on a terminal, a line a stage otherwise.

use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

/// Milliseconds that stages of work took, in order.
#[derive(Clone, Debug, Default)]
pub struct Progress {
    times: Vec<(String, f64)>,
    is_quiet: bool,
}

impl Progress {
    /// Says nothing: for work inside a stage.
    pub fn quiet() -> Self {
        Self {
            is_quiet: true,
            ..Self::default()
        }
    }

    /// Does `work` for each item, with a bar of how many are done and a line of what it says of each.
    ///
    /// # Errors
    /// The first of the work's.
    pub fn each<T, E>(
        &mut self,
        name: &str,
        items: &[T],
        mut work: impl FnMut(&T) -> Result<String, E>,
    ) -> Result<(), E> {
        let bar = new_bar(name);
        let start = Instant::now();
        for (done, item) in items.iter().enumerate() {
            bar.set_length(items.len() as u64);
            bar.set_position(done as u64);
            let line = work(item)?;
            bar.suspend(|| eprintln!("{line}"));
        }
        bar.finish_and_clear();
        self.times
            .push((name.to_owned(), start.elapsed().as_secs_f64() * 1e3));
        Ok(())
    }

    /// Does a stage of work and says on standard error how long it took.
    /// The work reports units done and their total, from any thread.
    pub fn run<T>(&mut self, name: &str, work: impl FnOnce(&(dyn Fn(u64, u64) + Sync)) -> T) -> T {
        let bar = if self.is_quiet {
            ProgressBar::hidden()
        } else {
            new_bar(name)
        };
        let start = Instant::now();
        let result = work(&|done, total| {
            bar.set_length(total);
            bar.set_position(done);
        });
        let milliseconds = start.elapsed().as_secs_f64() * 1e3;
        bar.finish_and_clear();
        if !self.is_quiet {
            eprintln!("{name}: {milliseconds:.0} ms");
        }
        self.times.push((name.to_owned(), milliseconds));
        result
    }

    /// Each stage's name and milliseconds.
    pub fn times(&self) -> &[(String, f64)] {
        &self.times
    }
}

/// Draws to standard error, and only where that is a terminal.
fn new_bar(name: &str) -> ProgressBar {
    let style = ProgressStyle::with_template("{msg} {wide_bar} {percent:>3}% {eta}")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    let bar = ProgressBar::new(0)
        .with_style(style)
        .with_message(name.to_owned());
    bar.enable_steady_tick(Duration::from_millis(100));
    bar
}
