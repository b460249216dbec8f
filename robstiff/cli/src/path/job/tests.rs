use super::content::{Block, Job, Joint, Left, Point};
use super::{html, thin};

/// A job of so many points along a wave, with a force but on the rapids to it; each point is in the line after its number.
fn job(q: &[[f64; 2]]) -> Job<'_> {
    let error = |number: usize| 60e-6 + 20e-6 * (number as f64 * 0.37).sin();
    let points = q.iter().enumerate().map(|(number, q)| {
        let x = number as f64 * 1e-3;
        let cut = number > 1;
        Point {
            line: number + 2,
            text: "G1 X1",
            s: x,
            at: [x, 0.02 * (x * 30.0).sin(), 0.001 * (x * 7.0).cos()],
            rapid: !cut,
            feed: cut.then_some(0.05),
            q: &q[..],
            force: Some(if cut { 100.0 } else { 0.0 }),
            section: Some([0.008, 0.002]),
            distance: cut.then_some(90e-6),
            error: cut.then(|| -error(number)),
            after: None,
        }
    });
    Job {
        robot: "Arm".to_owned(),
        file: "part.ngc".to_owned(),
        forces: Some(("cut.yaml".to_owned(), "wall")),
        is_peak: false,
        points: points.collect(),
        joints: vec![
            Joint { unit: ("deg", 1_f64.to_degrees()), limits: Some([-1.0, 1.0]), fastest: Some(0.5) },
            Joint { unit: ("mm", 1e3), limits: None, fastest: None },
        ],
        stock: Some(Block {
            outline: vec![[0.0, -0.03], [0.1, -0.03], [0.1, 0.03], [0.0, 0.03]],
            heights: [-0.01, 0.0],
        }),
        tolerance: Some(100e-6),
        corrected: None,
        shares: vec![("joint 2".to_owned(), 0.6), ("link_compliance@link 3".to_owned(), 0.3)],
        chatter: None,
        summary: vec![("error of the wall".to_owned(), [1e-5, 2e-5, -8e-5])],
        files: vec!["part.src".to_owned()],
    }
}

fn coordinates(count: usize) -> Vec<[f64; 2]> {
    (0..count).map(|i| [0.3 * (i as f64 * 0.01).sin(), 0.1]).collect()
}

fn section<'p>(page: &'p str, title: &str) -> &'p str {
    let rest = page.split_once(&format!("<h2>{title}</h2>")).unwrap_or_else(|| panic!("{title} is missing")).1;
    rest.split("<h2>").next().unwrap()
}

#[test]
fn the_page_has_its_sections_and_the_worst_line() {
    let q = coordinates(200);
    let mut job = job(&q);
    (job.points[70].error, job.points[71].error, job.points[150].error) = (Some(-95e-6), Some(94e-6), Some(90e-6));
    job.points[70].text = "N70 G1 X70 (worst)";
    let page = html(&job);
    for title in ["The path", "Along the job", "The worst places", "The joints", "What would help most"] {
        section(&page, title);
    }
    assert!(page.contains("from above") && page.contains("from the side") && page.contains("polygon class=\"stock\""));
    assert!(page.contains("track rapid") && page.contains("shade9"), "{page}");
    let places = section(&page, "The worst places");
    let rows: Vec<&str> = places.split("<tr").skip(2).collect();
    assert!(
        rows[0].contains(">72<") && rows[0].contains("N70 G1 X70 (worst)") && rows[0].contains(">95.0<"),
        "{}",
        rows[0]
    );
    // Its neighbour is the same place.
    assert!(rows[1].contains(">152<"), "{}", rows[1]);
    assert!(section(&page, "What would help most").contains("Relieve joint 2"));
    assert!(
        !page.contains("http://")
            || page.matches("http://").count() == page.matches("http://www.w3.org/2000/svg").count()
    );
}

#[test]
fn the_tolerance_is_judged_as_the_path_is_commanded() {
    let q = coordinates(50);
    let mut job = job(&q);
    let page = html(&job);
    assert!(page.contains(">pass<") && page.contains("Within the tolerance of ±100.0 µm"), "{page}");
    job.points[20].error = Some(-130e-6);
    let page = html(&job);
    assert!(page.contains(">fail<") && page.contains("at 1 of 48 points") && page.contains("up to 130.0 µm"), "{page}");
    job.corrected = Some(Left { by: 0.1, worst: 13e-6 });
    job.points.iter_mut().for_each(|point| point.after = point.distance.map(|_| 1e-9));
    let page = html(&job);
    assert!(page.contains(">pass<") && page.contains("if the model is true") && page.contains("13.0 µm off"), "{page}");
    job.tolerance = None;
    let page = html(&job);
    assert!(!page.contains(">pass<") && !page.contains(">fail<"), "{page}");
    job.forces = None;
    job.points.iter_mut().for_each(|point| (point.error, point.distance, point.after) = (None, None, None));
    let page = html(&job);
    assert!(page.contains("No force is given") && !page.contains("Along the job"), "{page}");
}

#[test]
fn a_joint_that_is_too_fast_is_named_with_the_feed_that_it_follows() {
    let mut q = coordinates(50);
    // 1 mm at 50 mm/s takes 20 ms: 1 rad/s, of 0.5.
    q[30] = [q[29][0] + 0.02, 0.1];
    q[31..].iter_mut().for_each(|q| q[0] += 0.02);
    let job = job(&q);
    let (i, speed) = job.travel(0).speed.unwrap();
    assert!(i == 30 && (speed - 1.0).abs() < 0.01, "{i} {speed}");
    assert_eq!(job.travel(0).margin.unwrap().0, 49);
    assert_eq!(job.travel(1).speed.unwrap().1, 0.0);
    // A rapid has no speed that is known.
    assert_eq!(job.speed(1, 0), None);
    let page = html(&job);
    assert!(page.contains("Too fast at the feeds of the path: joint 1."), "{page}");
    assert!(section(&page, "What would help most").contains("Line 32: a feed of 1500 mm/min at most"), "{page}");
}

#[test]
fn texts_of_files_are_no_markup() {
    let bad = "<script>alert(\"a & 'b'\")</script>\u{202e}";
    let q = coordinates(20);
    let mut job = job(&q);
    (job.robot, job.file, job.forces) = (bad.to_owned(), bad.to_owned(), Some((bad.to_owned(), "wall")));
    job.points.iter_mut().for_each(|point| point.text = bad);
    (job.shares, job.files) = (vec![(bad.to_owned(), 0.9)], vec![bad.to_owned()]);
    job.summary = vec![(bad.to_owned(), [f64::NAN; 3])];
    job.points[3].error = Some(f64::NAN);
    let page = html(&job);
    assert!(!page.contains("<script") && !page.contains('\u{202e}'), "{page}");
    assert!(page.contains("&lt;script&gt;alert"));
    assert!(!page.contains("NaN") && !page.contains("inf"), "{page}");
}

#[test]
fn a_long_job_is_a_small_page_that_has_its_extremes() {
    let q = coordinates(40_000);
    let mut job = job(&q);
    job.points[23_456].error = Some(-321e-6);
    let page = html(&job);
    assert!(page.len() < 1_000_000, "{}", page.len());
    assert!(page.contains("up to 321.0 µm") && page.contains(">23458<"));
    assert!(page.contains("shade9 wide9"));
}

#[test]
fn thinned_lines_keep_the_extremes_of_every_step_and_break_at_gaps() {
    let value = |i: usize| {
        (i != 5000).then(|| {
            if i == 777 {
                9.0
            } else if i == 778 {
                -9.0
            } else {
                (i as f64 * 0.1).sin()
            }
        })
    };
    let lines = thin::lines((0..10_000).map(|i| (i as f64, value(i))), [0.0, 9999.0], 100);
    let drawn: Vec<[f64; 2]> = lines.concat();
    assert!(drawn.len() <= 200 && drawn.contains(&[777.0, 9.0]) && drawn.contains(&[778.0, -9.0]), "{}", drawn.len());
    assert!(drawn.windows(2).all(|pair| pair[0][0] < pair[1][0]));
    let lines = thin::lines([(0.0, Some(1.0)), (1.0, None), (2.0, Some(2.0)), (3.0, Some(2.5))], [0.0, 3.0], 100);
    assert_eq!(lines, [vec![[0.0, 1.0]], vec![[2.0, 2.0], [3.0, 2.5]]]);
}

#[test]
fn strokes_are_bounded_near_the_track_and_of_its_highest_rank() {
    // To and fro over a square, with one point that is worse.
    let at = |i: usize| {
        let (row, k) = (i / 100, i % 100);
        let x = if row % 2 == 0 { k } else { 99 - k } as f64;
        ([4.0 * x, 0.4 * row as f64], if i == 43_210 { 9 } else { 2 })
    };
    let points: Vec<([f64; 2], u8)> = (0..100_000).map(at).collect();
    let found = thin::strokes(&points, 2000);
    assert!(found.iter().map(|(_, strokes)| strokes.len()).sum::<usize>() <= 2000);
    let (rank, worst) = found.last().unwrap();
    assert_eq!(*rank, 9);
    let [x, y] = points[43_210].0;
    assert!(worst.iter().flatten().any(|end| (end[0] - x).hypot(end[1] - y) < 20.0), "{worst:?}");
    // A straight line is one stroke, and a dot is one.
    let line: Vec<([f64; 2], u8)> = (0..60).map(|i| ([f64::from(i), 0.5 * f64::from(i)], 3)).collect();
    assert_eq!(thin::strokes(&line, 100), [(3, vec![[[0.0, 0.0], [59.0, 29.5]]])]);
    assert_eq!(thin::strokes(&[([1.0, 1.0], 0), ([1.1, 1.0], 4)], 100), [(4, vec![[[1.0, 1.0], [1.0, 1.0]]])]);
}
