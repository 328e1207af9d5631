//! Whole suites on tiny pictures.

use std::time::Duration;

use serde_json::{Value, json};
use tyndall::techniques::{Backends, TABLE, Technique};

use super::{
    billeter, lin,
    paper::{self, Paper},
    poses,
    report::{Bench, Report, header},
    subject,
    suites::SUITES,
    table::Table,
};
use crate::{
    backend::{Backend, BackendChoice},
    progress::Progress,
};

const TINY: Paper = Paper {
    techniques: &["min-max", "sleight-of-hand"],
    scenes: &[subject::DRAGON],
    size: [64, 48],
    reduction: 4,
    map: 128,
    spot_maps: &[64, 128],
};

fn bench(backend: Backend) -> Bench {
    Bench {
        backend,
        assets: None,
    }
}

/// The only row of a technique, by column.
fn row<'a>(table: &'a Value, technique: &str) -> &'a Value {
    let rows = table["rows"].as_array().unwrap();
    let mut of_name = rows.iter().filter(|row| row["technique"] == technique);
    let row = of_name.next().unwrap();
    assert!(of_name.next().is_none(), "{table:#}");
    row
}

#[test]
fn a_paper_gets_its_tables_and_what_is_missing_is_named() {
    let choice = BackendChoice::Auto;
    let bench = bench(Backend::choose(choice, &[Technique::default().info()]).unwrap());
    let report = paper::run(&TINY, &bench, &mut Progress::default()).unwrap();
    assert_eq!(report.missing, ["sleight-of-hand"]);
    let json: Vec<Value> = report.tables.iter().map(Table::to_json).collect();
    let [quality, _passes, maps] = &json[..] else {
        panic!("expected three tables, found {json:#?}");
    };
    assert_eq!(quality["title"], "dragon (builtin:slats in its place)");
    let own = row(quality, "min-max");
    assert!(own["ms"]["median"].as_f64().unwrap() > 0.0, "{own:#}");
    // Measured: 0.031, of 16 x 12 pixels (2026-11-22).
    assert!(own["relMAE"].as_f64().unwrap() < 0.05, "{own:#}");
    assert!(!own["equal-quality steps"].is_null(), "{own:#}");
    assert!(own["speed-up"].is_string(), "{own:#}");
    assert!(own["equal-time steps"].as_u64().unwrap() >= 1, "{own:#}");
    let sides: Vec<_> = maps["rows"]
        .as_array()
        .unwrap()
        .iter()
        .map(|r| r["map side"].as_u64())
        .collect();
    assert_eq!(sides, [Some(64), Some(128)]);
}

#[test]
fn brute_force_stands_alone_where_a_papers_techniques_are_missing() {
    let paper = Paper {
        techniques: &["sleight-of-hand"],
        spot_maps: &[],
        ..TINY
    };
    let report = paper::run(&paper, &bench(Backend::Cpu), &mut Progress::default()).unwrap();
    let quality = report.tables[0].to_json();
    let march = row(&quality, "ray-march");
    assert_eq!(march["on"], "CPU");
    assert!(
        march["x limit"].is_null() && march["speed-up"].is_null(),
        "{march:#}"
    );
}

#[test]
fn a_report_says_what_it_is_and_what_is_missing() {
    let suite = &SUITES[0];
    let report = Report {
        tables: Vec::new(),
        missing: vec!["a", "b"],
        faults: Vec::new(),
    };
    let text = report.to_text(suite.name, suite.about, Duration::from_secs(7));
    assert!(text.starts_with("\n== chen: "), "{text}");
    assert!(
        text.contains("\nmissing: a, b\n") && text.ends_with("measured in 7 s\n"),
        "{text}"
    );
    assert_eq!(report.to_json(suite.name)["missing"], json!(["a", "b"]));
    let header = header(&bench(Backend::Cpu));
    assert!(
        header
            .iter()
            .any(|line| line == &("adapter", "none: the CPU".to_owned()))
    );
}

/// A handful of places a scene, and small pictures.
#[test]
fn from_random_places_every_technique_keeps_to_its_worst() {
    let bench = Bench {
        backend: Backend::choose(BackendChoice::Auto, &[Technique::default().info()]).unwrap(),
        assets: subject::find_assets(),
    };
    let suite = poses::Poses {
        poses: 3,
        size: [40, 30],
    };
    let report = poses::run(&suite, &bench, &mut Progress::default()).unwrap();
    let table = report.tables[0].to_json();
    // A handful of pictures has no 99th percentile, which the suite's faults are about as well.
    for row in table["rows"].as_array().unwrap() {
        assert_eq!(row["not finite"], 0, "{row:#}");
        let [largest, worst] = ["largest error", "its worst"].map(|key| row[key].as_f64().unwrap());
        assert!(largest <= worst, "{row:#}");
    }
    let is_gpu = matches!(bench.backend, Backend::Gpu(_));
    for info in TABLE.iter().filter(|info| !info.is_reference) {
        for (on, is_there) in [
            ("CPU", info.backends.include(Backends::Cpu)),
            ("GPU", is_gpu && info.backends.include(Backends::Gpu)),
        ] {
            let mut rows = table["rows"].as_array().unwrap().iter();
            let row = rows.find(|row| row["technique"] == info.name && row["on"] == on);
            assert_eq!(
                row.is_some(),
                is_there,
                "{} on the {on}: {table:#}",
                info.name
            );
            assert!(
                row.is_none_or(|row| row["pixels"].as_u64().unwrap() > 0),
                "{row:#?}"
            );
        }
    }
}

#[test]
fn light_volumes_are_measured_by_mesh_and_map() {
    let Some(gpu) = crate::measure::tests::gpu_or_skip("tyndall bench billeter") else {
        return;
    };
    let suite = billeter::LightVolumes {
        scene: subject::DRAGON,
        size: [64, 48],
        maps: &[64],
    };
    let report = billeter::run(&suite, &bench(gpu), &mut Progress::default()).unwrap();
    let json: Vec<Value> = report.tables.iter().map(Table::to_json).collect();
    assert_eq!(
        json[0]["title"],
        "dragon (builtin:slats in its place), two suns"
    );
    let rows = json[0]["rows"].as_array().unwrap();
    let triangles: Vec<_> = rows
        .iter()
        .map(|r| r["triangles"].as_u64().unwrap())
        .collect();
    // Two suns, 65 x 65 cells of two triangles.
    assert_eq!(triangles[0], 2 * 65 * 65 * 2);
    assert!(triangles.is_sorted_by(|a, b| a > b), "{triangles:?}");
    for row in rows {
        assert!(
            row["ms, mesh stays"]["median"].as_f64().unwrap() > 0.0,
            "{row:#}"
        );
        // Measured: 0.011.
        assert!(row["relMAE"].as_f64().unwrap() < 0.02, "{row:#}");
    }
}

#[test]
fn reuse_is_timed_and_what_is_left_stale_is_counted() {
    let backend = Backend::choose(BackendChoice::Auto, &[Technique::default().info()]).unwrap();
    let is_gpu = matches!(backend, Backend::Gpu(_));
    let films = lin::Films {
        scenes: &[(subject::YEAH_RIGHT, "1.10")],
        size: [64, 48],
        map: 64,
        timed: 2,
        compared_size: [48, 36],
        compared: 3,
    };
    let report = lin::run(&films, &bench(backend), &mut Progress::default()).unwrap();
    if !is_gpu {
        return;
    }
    let json: Vec<Value> = report.tables.iter().map(Table::to_json).collect();
    let [times, by_marching, left, walks] = &json[..] else {
        panic!("expected four tables, found {json:#?}");
    };
    for times in [times, by_marching] {
        let row = &times["rows"][0];
        assert_eq!(row["of"], "builtin:sponge");
        assert!(row["speed-up"].as_f64().unwrap() > 0.0, "{row:#}");
        let covered = row["change: covered"].as_f64().unwrap();
        assert!(covered > 0.0 && covered <= 1.0, "{row:#}");
    }
    let left = left["rows"].as_array().unwrap();
    assert_eq!(left[0]["mask"], "change");
    assert_eq!(left[0]["stale pixels"], 0, "{left:#?}");
    let walks = walks["rows"].as_array().unwrap();
    assert_eq!(walks.len(), 8, "{walks:#?}");
    for row in walks {
        let [computed, error, tolerance] =
            ["computed", "error", "tolerance"].map(|key| row[key].as_f64().unwrap());
        assert!(computed > 0.0 && computed <= 1.0, "{row:#}");
        assert!(error < tolerance, "{row:#}");
    }
}
