//! `forces --fit`: cutting coefficients from recorded forces.

mod common;

use std::fs;
use std::path::{Path, PathBuf};

use common::{fail, folder, inside, json, keys, run, succeed};

/// The records of the page, in a folder that a test may spoil; the list.
fn copy(folder: &Path) -> String {
    let files = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/commands/files");
    for name in ["slots.yaml", "slot-040.txt", "slot-070.txt", "slot-100.txt", "slot-130.txt"] {
        fs::copy(files.join(name), folder.join(name)).unwrap();
    }
    inside(folder, "slots.yaml")
}

/// Which made the records, with noise; a program of its own summed them over discs and teeth.
const TRUE: [(&str, f64); 6] = [
    ("Ktc_Pa", 767.01e6),
    ("Kte_N_per_m", 27.7e3),
    ("Krc_Pa", 168.8e6),
    ("Kre_N_per_m", 26.6e3),
    ("Kac_Pa", 222e6),
    ("Kae_N_per_m", 0.7e3),
];

#[test]
fn coefficients_are_found_and_can_be_used() {
    let folder = folder("forces-fit");
    let list = copy(&folder);
    for by in ["mean", "revolution"] {
        let (out, told) = (inside(&folder, &format!("{by}.yaml")), inside(&folder, &format!("{by}.json")));
        let mut arguments = vec!["forces", "--fit", &list, "--out", &out, "--json", &told];
        if by == "revolution" {
            arguments.push("--revolution");
        }
        let page = succeed(&arguments);
        assert!(page.contains("4 records, coefficients by the ") && page.contains("slot-130.txt"), "{page}");
        let document = json(&told);
        assert_eq!(keys(&document), ["by", "coefficients", "std", "records"]);
        assert_eq!(document["by"], by);
        for (name, truth) in TRUE {
            let [found, std] = ["coefficients", "std"].map(|of| document[of][name].as_f64().unwrap());
            // Five standard deviations of means of 120 samples with 4 N of noise.
            let most = if name.ends_with("_Pa") { 20e6 } else { 1e3 };
            assert!((found - truth).abs() < most && std > 0.0 && std < most, "{by} {name}: {found} +- {std}");
        }
        for record in document["records"].as_array().unwrap() {
            let turn = &record["revolution"];
            assert!(turn["predicted_rms_error_N"].as_f64() < turn["rms_N"].as_f64().map(|rms| 0.1 * rms), "{record}");
        }
        let used = succeed(&["forces", &out]);
        assert!(used.contains("slots in 7075-T6") && used.contains("9000 rpm; 2 mm deep, 0.04 mm a tooth"), "{used}");
    }
}

#[test]
fn what_cannot_be_fitted_is_explained_and_not_written() {
    let folder = folder("forces-unfit");
    let (list, out) = (copy(&folder), inside(&folder, "out.yaml"));
    let text = fs::read_to_string(&list).unwrap();
    let refused = |from: &str, to: &str, code: i32, part: &str| {
        assert!(text.contains(from), "{from}");
        fs::write(&list, text.replace(from, to)).unwrap();
        let said = fail(code, &["forces", "--fit", &list, "--out", &out]);
        assert!(said.contains(part), "{said}");
        assert!(!PathBuf::from(&out).exists());
    };
    refused("feed: 0.07", "feed: 0.04 m", 1, "slots.yaml:11:");
    let one = "records:\n  - {file: slot-040.txt, feed: 0.04 mm/tooth}\n";
    let others = text.split_once("records:").unwrap().1;
    refused(&format!("records:{others}"), one, 1, "they need cuts of two feeds per tooth");
    fs::write(&list, &text).unwrap();
    let said = fail(1, &["forces", "--fit", &list, "--out", &inside(&folder, "slot-040.txt")]);
    assert!(said.contains("is one of the files that were read"), "{said}");
    fs::write(folder.join("slot-070.txt"), "DynoWare\nTime\tFx\tFy\tFz\ns\tN\tN\tN\n0\t1\tx\t2\n").unwrap();
    refused("on: workpiece", "on: workpiece ", 1, "slot-070.txt:4:5");
    let ran = run(&["forces"]);
    assert_eq!(ran.code, 2, "{}", ran.err);
    let ran = run(&["forces", &list, "--out", &out]);
    assert_eq!(ran.code, 2, "{}", ran.err);
}
