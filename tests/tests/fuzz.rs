//! A bounded run of the targets of fuzzing: the kept corpus, texts of the grammars, and both
//! with changes. The same inputs every time. `ROBSTIFF_FUZZ=100 cargo test -p robstiff-tests
//! --test fuzz` has a hundred times as many; `tests/fuzz` looks for inputs by what code they reach.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::{env, fs};

use arbitrary::Unstructured;
use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use robstiff_tests::fuzz::grammar::text;
use robstiff_tests::fuzz::mutated::mutated;
use robstiff_tests::fuzz::{TARGETS, Target, target};

/// Texts of a grammar.
const MADE: u64 = 400;

/// Changed texts for each of the corpus and of the grammar.
const CHANGED: u64 = 1200;

/// The bytes that rules are chosen by.
const CHOICES: usize = 400;

fn corpus(target: &Target) -> Vec<(PathBuf, Vec<u8>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus").join(target.name);
    let files = fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut files: Vec<PathBuf> = files.map(|file| file.expect("a file").path()).collect();
    files.sort();
    files.into_iter().map(|path| (path.clone(), fs::read(path).expect("a file of the corpus"))).collect()
}

/// What the target says of the bytes. Bytes with which something is wrong are kept in a file.
fn attempt(target: &Target, data: &[u8]) -> Result<(), String> {
    catch_unwind(AssertUnwindSafe(|| (target.check)(data))).unwrap_or_else(|_| {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("fuzz-{}", target.name));
        fs::write(&path, data).expect("the file of a failure");
        panic!("{}: see above, with the bytes in {}:\n{}", target.name, path.display(), String::from_utf8_lossy(data))
    })
}

fn run(name: &str) {
    let (target, times) = (target(name), env::var("ROBSTIFF_FUZZ").map_or(1, |times| times.parse().expect("a number")));
    let mut texts: Vec<Vec<u8>> = Vec::new();
    for (path, data) in corpus(&target) {
        let said = attempt(&target, &data);
        let is_refused = path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("refused"));
        assert_eq!(said.is_err(), is_refused, "{}: {}", path.display(), said.err().unwrap_or_default());
        texts.push(data);
    }
    let kept = texts.len();
    assert!(kept > 0, "the corpus is empty");
    let mut accepted = 0;
    for seed in 0..MADE * times {
        let mut choices = [0; CHOICES];
        ChaCha8Rng::seed_from_u64(seed).fill_bytes(&mut choices);
        let text = text(target.grammar, &mut Unstructured::new(&choices)).expect("a text").into_bytes();
        accepted += u64::from(attempt(&target, &text).is_ok());
        texts.push(text);
    }
    // Else the grammar's rules are not those of the reader.
    assert!(20 * accepted >= MADE * times, "{accepted} of {} texts of the grammar are accepted", MADE * times);
    for seed in 0..CHANGED * times {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut some = |among: usize| &texts[random.random_range(0..among)];
        let (one, other) = (some(if seed % 2 == 0 { kept } else { texts.len() }), some(texts.len()));
        let _ = attempt(&target, &mutated(one, other, target.grammar, seed));
    }
}

#[test]
fn no_folder_of_the_corpus_is_left_alone() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus");
    for entry in fs::read_dir(folder).expect("the corpus") {
        let name = entry.expect("a folder").file_name().to_string_lossy().into_owned();
        assert!(TARGETS.iter().any(|target| target.name == name), "no target is named {name}");
    }
}

macro_rules! targets {
    ($($name:ident)*) => {
        $(
            #[test]
            fn $name() {
                run(stringify!($name));
            }
        )*

        #[test]
        fn every_target_is_run() {
            let names: Vec<&str> = TARGETS.iter().map(|target| target.name).collect();
            assert_eq!(names, [$(stringify!($name)),*]);
        }
    };
}

targets! { descriptions campaigns tables paths urdf cuts maps }
