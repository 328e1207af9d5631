//! The inputs that fuzzing began with and those it found, as plain tests; and frames of random bytes, without a fuzzer.

// A test says that something is wrong by panicking.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::{
    fs,
    panic::{AssertUnwindSafe, catch_unwind},
    path::PathBuf,
    time::{Duration, Instant},
};

use rand_pcg::{Pcg32, rand_core::Rng};
use tyndall_fuzz::{Outcome, frame, gltf, picture, shot};
use tyndall_testkit::device::device_or_skip;

/// No input may take longer, wherever tests run: the first frame of a kind compiles its pipelines, seconds on a software driver.
const LIMIT: Duration = Duration::from_secs(30);

fn kept(target: &str) -> Vec<(PathBuf, Vec<u8>)> {
    let folder = format!("{}/../../fuzz/kept/{target}", env!("CARGO_MANIFEST_DIR"));
    let files = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path());
    files
        .map(|file| (file.clone(), fs::read(&file).unwrap()))
        .collect()
}

/// Runs a target's inputs, of which some have to be computed to the end and others refused.
fn run(target: &str, body: impl Fn(&[u8]) -> Outcome) {
    let mut ends = Vec::new();
    for (file, bytes) in kept(target) {
        eprintln!("{}", file.display());
        let start = Instant::now();
        ends.push(body(&bytes));
        assert!(start.elapsed() < LIMIT, "{}", file.display());
    }
    // At least one has to get to the end, for inputs that are all refused test nothing.
    assert!(ends.contains(&Outcome::Computed), "{target}: {ends:?}");
}

#[test]
fn shots() {
    run("shot", shot::run);
}

#[test]
fn scenes() {
    run("gltf", gltf::run);
}

#[test]
fn pictures() {
    run("picture", picture::run);
}

#[test]
fn frames() {
    run("frame", frame::on_cpu);
}

#[test]
fn frames_on_the_gpu() {
    if device_or_skip("kept frames").is_some() {
        run("frame", |bytes| frame::on_gpu(bytes).unwrap());
    }
}

fn random(count: u64, body: impl Fn(&[u8]) -> Outcome) {
    let first: u64 = std::env::var("TYNDALL_FUZZ_SEED").map_or(1, |seed| seed.parse().unwrap());
    let (mut computed, mut failed) = (0, Vec::new());
    for seed in first..first + count {
        let mut random = Pcg32::new(seed, 1);
        let bytes: Vec<u8> = (0..400).map(|_| random.next_u32() as u8).collect();
        let start = Instant::now();
        match catch_unwind(AssertUnwindSafe(|| body(&bytes))) {
            Ok(outcome) if start.elapsed() < LIMIT => {
                computed += u64::from(outcome == Outcome::Computed)
            }
            Ok(_) => failed.push(format!("seed {seed} took {:?}", start.elapsed())),
            Err(_) => failed.push(format!("seed {seed} panicked")),
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
    eprintln!("{computed} of {count} computed");
    // Fewer would mean that inputs do not get past the checks.
    assert!(10 * computed >= count, "{computed} of {count}");
}

fn count(default: u64) -> u64 {
    std::env::var("TYNDALL_FUZZ_COUNT").map_or(default, |count| count.parse().unwrap())
}

#[test]
fn random_frames() {
    random(count(2000), frame::on_cpu);
}

#[test]
fn random_frames_on_the_gpu() {
    if device_or_skip("random frames").is_some() {
        random(count(12), |bytes| frame::on_gpu(bytes).unwrap());
    }
}
