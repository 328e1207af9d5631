//! A comparison as files in a folder: pictures for people and for programs, the legends and plots, and the page.

use std::path::{Path, PathBuf};

use super::{
    error::FileError,
    error_map::{self, ErrorMap},
    html,
    plot::{self, ErrorKind},
    png::png,
    report::{Comparison, Report},
};
use crate::{
    layer::Layer,
    output::{Format, WriteError, write_atomically},
    picture::Picture,
};

/// Makes the folder, and the ones it is in, where they are missing.
///
/// # Errors
/// [`FileError::Folder`] where the system refuses.
pub fn make_folder(folder: &Path) -> Result<(), FileError> {
    std::fs::create_dir_all(folder).map_err(|cause| FileError::Folder {
        folder: folder.to_owned(),
        cause,
    })
}

/// Writes everything into the folder, the page last; returns the page's path.
///
/// # Errors
/// [`FileError`] where a picture cannot be made or the system refuses. No file is ever half written.
pub fn write(comparison: &Comparison, folder: &Path) -> Result<PathBuf, FileError> {
    let Comparison {
        report,
        reference,
        pictures,
    } = comparison;
    write_picture(folder, "reference", reference, report.exposure)?;
    for (row, picture) in report.rows.iter().zip(pictures) {
        let stem = row.setting.file_stem();
        write_picture(folder, &stem, picture, report.exposure)?;
        let errors = error_map::relative_errors(picture, reference);
        for map in ErrorMap::ALL {
            let file = folder.join(format!("{stem}.{}.png", map.file_stem()));
            write_atomically(&file, &png(&map.colors(&errors), picture.size)?)?;
        }
    }
    write_plots(folder, report)?;
    let page = folder.join("report.html");
    write_atomically(&page, html::page(comparison)?.as_bytes())?;
    Ok(page)
}

/// The numbers as JSON.
///
/// # Errors
/// [`WriteError`] where the system refuses.
pub fn write_json(report: &Report, file: &Path) -> Result<(), WriteError> {
    let text = format!("{:#}\n", report.to_json());
    write_atomically(file, text.as_bytes())
}

/// A picture as linear values, and as people see it.
fn write_picture(folder: &Path, stem: &str, picture: &Picture, ev: f32) -> Result<(), FileError> {
    let layers = vec![(Layer::Inscatter, picture.clone())];
    Format::Exr.write(&folder.join(format!("{stem}.exr")), &layers, ev)?;
    Format::Png.write(&folder.join(format!("{stem}.png")), &layers, ev)?;
    Ok(())
}

fn write_plots(folder: &Path, report: &Report) -> Result<(), FileError> {
    for map in ErrorMap::ALL {
        let file = folder.join(format!("legend.{}.svg", map.file_stem()));
        write_atomically(&file, plot::legend(map)?.as_bytes())?;
    }
    for kind in [ErrorKind::RelMae, ErrorKind::P99] {
        let file = folder.join(format!("{}-against-time.svg", kind.file_stem()));
        write_atomically(&file, plot::error_against_time(report, kind)?.as_bytes())?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::fixture;

    #[test]
    fn every_row_has_its_files_and_linear_values_survive() {
        let folder = tempfile::tempdir().unwrap();
        let nested = folder.path().join("a/b");
        make_folder(&nested).unwrap();
        let comparison = fixture::comparison();
        write(&comparison, &nested).unwrap();
        let mut names: Vec<String> = std::fs::read_dir(&nested)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        // 3 rows of 4 files, 2 of the reference, 2 legends, 2 plots, the page.
        assert_eq!(names.len(), 19, "{names:?}");
        assert!(names.contains(&"ray-march-steps-64.signed-error.png".to_owned()));
        let read =
            tyndall_testkit::picture::Picture::read_exr(&nested.join("ray-march-steps-64.exr"));
        let read = read.unwrap();
        for (found, expected) in read.pixels().iter().zip(&comparison.pictures[0].pixels) {
            assert_eq!(found, &expected.map(f64::from));
        }
    }

    #[test]
    fn a_folder_that_cannot_be_made_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        std::fs::write(&file, "").unwrap();
        let message = make_folder(&file.join("sub")).unwrap_err().to_string();
        assert!(message.contains("file/sub"), "{message}");
    }

    #[test]
    fn json_has_the_numbers() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("report.json");
        let mut report = fixture::report();
        report.rows[0].errors.bias = f64::INFINITY;
        write_json(&report, &file).unwrap();
        let json: serde_json::Value =
            serde_json::from_slice(&std::fs::read(&file).unwrap()).unwrap();
        assert_eq!(json["rows"][1]["errors"]["rel_mae"], 0.025);
        assert_eq!(json["rows"][0]["errors"]["bias"], serde_json::Value::Null);
        assert_eq!(json["rows"][2]["setting"]["parameters"]["steps"], "1024");
        assert_eq!(json["rows"][2]["timing"]["total"]["median"], 0.1 * 1024.0);
        assert_eq!(json["adapter"]["name"], "a GPU");
    }
}
