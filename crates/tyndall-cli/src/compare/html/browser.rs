//! The page in a browser: Chromium without a screen, driven by chromedriver over WebDriver (W3C).

use std::{
    io::{BufRead, BufReader, ErrorKind},
    process::{Child, Command, Stdio},
};

use serde_json::{Value, json};
use tyndall_testkit::skip::skip;

use super::page;
use crate::compare::fixture;

/// A browser that shows one page, gone when it is dropped.
struct Browser {
    driver: Child,
    agent: ureq::Agent,
    /// The session's address.
    session: String,
}

impl Browser {
    /// Starts the browser; `None` where there is none.
    fn start(what: &str) -> Option<Self> {
        let driver = Command::new("chromedriver")
            .arg("--port=0")
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn();
        let mut driver = match driver {
            Err(error) if error.kind() == ErrorKind::NotFound => {
                skip(
                    what,
                    "there is no chromedriver (Debian: apt-get install chromium chromium-driver)",
                );
                return None;
            }
            driver => driver.unwrap(),
        };
        let port = port(&mut driver);
        let config = ureq::Agent::config_builder().proxy(None).build();
        let mut browser = Self {
            driver,
            agent: config.into(),
            session: format!("http://127.0.0.1:{port}/session"),
        };
        let arguments = ["--headless=new", "--no-sandbox", "--window-size=1200,1400"];
        let answer = browser.post(
            "",
            &json!({ "capabilities": { "alwaysMatch": {
            "browserName": "chrome",
            "goog:chromeOptions": { "args": arguments },
            "goog:loggingPrefs": { "browser": "ALL" },
        } } }),
        );
        let id = answer["sessionId"].as_str().unwrap();
        browser.session = format!("{}/{id}", browser.session);
        Some(browser)
    }

    fn post(&self, path: &str, body: &Value) -> Value {
        let mut answer = self
            .agent
            .post(format!("{}{path}", self.session))
            .send_json(body)
            .unwrap();
        let answer: Value = answer.body_mut().read_json().unwrap();
        answer["value"].clone()
    }

    /// Runs a function's body and gives its result.
    fn script(&self, body: &str) -> Value {
        self.post("/execute/sync", &json!({ "script": body, "args": [] }))
    }

    fn text(&self, body: &str) -> String {
        self.script(body).as_str().unwrap().to_owned()
    }

    /// Position in the window of a share of an element's width and height \[pixels].
    fn point(&self, id: &str, [x, y]: [f64; 2]) -> [i64; 2] {
        let point = self.script(&format!(
            "const b = document.getElementById('{id}').getBoundingClientRect();
             return [b.left + {x} * b.width, b.top + {y} * b.height];"
        ));
        [0, 1].map(|i| point[i].as_f64().unwrap().round() as i64)
    }

    /// Moves a pointer through points of the window; between the first and the last it is down, if it drags.
    fn pointer(&self, kind: &str, points: &[[i64; 2]], drags: bool) {
        let go =
            |[x, y]: &[i64; 2]| json!({ "type": "pointerMove", "duration": 20, "x": x, "y": y });
        let mut actions: Vec<Value> = points.iter().map(go).collect();
        if drags {
            actions.insert(1, json!({ "type": "pointerDown", "button": 0 }));
            actions.push(json!({ "type": "pointerUp", "button": 0 }));
        }
        self.post(
            "/actions",
            &json!({ "actions": [{
            "type": "pointer",
            "id": kind,
            "parameters": { "pointerType": kind },
            "actions": actions,
        }] }),
        );
    }

    fn key(&self, key: &str) {
        let actions = ["keyDown", "keyUp"].map(|kind| json!({ "type": kind, "value": key }));
        self.post(
            "/actions",
            &json!({ "actions": [
            { "type": "key", "id": "keyboard", "actions": actions }
        ] }),
        );
    }

    /// The divider's own value, and the cut of the right picture \[percent].
    fn divider(&self) -> [f64; 2] {
        let found = self.script(
            "return [Number(divider.getAttribute('aria-valuenow')),
                     parseFloat(document.getElementById('right-layer').style.clipPath.split(' ').at(-1))];",
        );
        [0, 1].map(|i| found[i].as_f64().unwrap())
    }

    /// The readout's pixel and a side's values.
    fn readout(&self, side: usize) -> (String, Vec<f64>) {
        let row = format!("document.querySelector('#readout tbody').rows[{side}]");
        let values = self.script(&format!(
            "return [1, 2, 3].map((i) => Number({row}.cells[i].textContent.replace('−', '-')))"
        ));
        let values = values.as_array().unwrap().iter();
        (
            self.text("return document.getElementById('pixel').textContent"),
            values.map(|v| v.as_f64().unwrap()).collect(),
        )
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        // The session's end closes the browser. Nothing better can be done where that fails.
        let _ = self.agent.delete(&self.session).call();
        let _ = self.driver.kill();
        let _ = self.driver.wait();
    }
}

/// The driver says where it listens.
fn port(driver: &mut Child) -> u16 {
    let lines = BufReader::new(driver.stdout.take().unwrap()).lines();
    lines
        .map(Result::unwrap)
        .find_map(|line| {
            let after = line.split_once("successfully on port ")?.1;
            after.trim_end_matches('.').parse().ok()
        })
        .unwrap()
}

fn assert_near(found: &[f64], expected: [f64; 3], tolerance: f64) {
    assert_eq!(found.len(), 3);
    for (found, expected) in found.iter().zip(expected) {
        assert!(
            (found - expected).abs() <= tolerance * expected.abs(),
            "{found} {expected}"
        );
    }
}

#[test]
fn the_page_works_in_a_browser() {
    let Some(browser) = Browser::start("the report in a browser") else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("report.html");
    let comparison = fixture::comparison();
    std::fs::write(&file, page(&comparison).unwrap()).unwrap();
    browser.post(
        "/url",
        &json!({ "url": format!("file://{}", file.display()) }),
    );
    browser.script(
        "document.getElementById('drawn').scrollIntoView({ block: 'start', behavior: 'instant' })",
    );

    divider_moves(&browser);
    values_are_under_the_pointer(&browser, &comparison);
    errors_are_read_as_such(&browser);
    the_table_sorts(&browser);

    let log = browser.post("/se/log", &json!({ "type": "browser" }));
    assert_eq!(log, json!([]), "the console is not silent");
}

fn divider_moves(browser: &Browser) {
    assert_eq!(browser.divider(), [50.0; 2]);
    for (kind, share) in [("mouse", 0.25), ("touch", 0.7)] {
        let from = browser.point("divider", [0.5, 0.5]);
        let to = browser.point("stage", [share, 0.4]);
        browser.pointer(kind, &[from, [(from[0] + to[0]) / 2, to[1]], to], true);
        for found in browser.divider() {
            // Points are rounded to pixels; the stage is more than 1000 wide.
            assert!((found - 100.0 * share).abs() <= 0.5, "{kind}: {found}");
        }
    }
    browser.script("document.getElementById('divider').focus()");
    let (left, right, home, end) = ("\u{e012}", "\u{e014}", "\u{e011}", "\u{e010}");
    for (key, expected) in [(left, 69.0), (right, 70.0), (home, 0.0), (end, 100.0)] {
        browser.key(key);
        assert_eq!(browser.divider()[0], expected);
    }
}

fn values_are_under_the_pointer(browser: &Browser, comparison: &crate::compare::Comparison) {
    let [width, height] = comparison.reference.size;
    let share = |[x, y]: [u32; 2]| {
        [
            (f64::from(x) + 0.5) / f64::from(width),
            (f64::from(y) + 0.5) / f64::from(height),
        ]
    };
    let check = |pixel: [u32; 2]| {
        let (name, left) = browser.readout(0);
        assert_eq!(name, format!("pixel {}, {}", pixel[0], pixel[1]));
        let (_, right) = browser.readout(1);
        let index = (pixel[1] * width + pixel[0]) as usize;
        let last = comparison.pictures.len() - 1;
        // Three digits of half floats.
        assert_near(
            &left,
            comparison.pictures[last].pixels[index].map(f64::from),
            6e-3,
        );
        assert_near(
            &right,
            comparison.reference.pixels[index].map(f64::from),
            6e-3,
        );
    };
    for pixel in [[20, 12], [31, 23], [5, 1]] {
        browser.pointer("mouse", &[browser.point("stage", share(pixel))], false);
        check(pixel);
    }
    // Zoomed in by two about the middle, the stage shows the middle half: its quarter is 3/8 of the picture.
    browser.script("document.getElementById('in').click()");
    let [x, y] = share([12, 9]).map(|share| 2.0 * share - 0.5);
    browser.pointer("mouse", &[browser.point("stage", [x, y])], false);
    check([12, 9]);
    // Dragged by an eighth of the stage, it shows a sixteenth of the picture further left.
    let from = browser.point("stage", [0.5, 0.5]);
    let to = browser.point("stage", [0.625, 0.5]);
    browser.script("document.getElementById('divider').style.pointerEvents = 'none'");
    browser.pointer("mouse", &[from, to], true);
    browser.pointer("mouse", &[browser.point("stage", [x + 0.125, y])], false);
    check([12, 9]);
    browser.script("document.getElementById('fit').click()");
}

/// The last row is brighter than the reference by 0.625 %.
fn errors_are_read_as_such(browser: &Browser) {
    browser.script(
        "const left = document.getElementById('left');
         const options = [...left.options].filter((o) => o.text.includes('signed error'));
         left.value = options.at(-1).value;
         left.dispatchEvent(new Event('change'));",
    );
    let unit = "return document.querySelector('#readout tbody').rows[0].cells[4].textContent";
    assert_eq!(browser.text(unit), "% of the mean");
    let mean = crate::compare::error_map::mean(&fixture::comparison().reference);
    let expected = [0.02 * 12.0, 0.03 * 9.0, 0.1].map(|v| 0.625 * v / mean);
    // f32 of the pictures and three digits of half floats.
    assert_near(&browser.readout(0).1, expected, 6e-3);
}

fn the_table_sorts(browser: &Browser) {
    let first = "return document.querySelector('#table tbody th').dataset.value";
    assert_eq!(browser.text(first), "ray-march steps 64");
    for expected in ["ray-march steps 1024", "ray-march steps 64"] {
        browser.script(
            "[...document.querySelectorAll('#table thead button')]
               .find((b) => b.textContent === 'relMAE').click()",
        );
        assert_eq!(browser.text(first), expected);
    }
}
