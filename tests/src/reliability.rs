//! Whether what is reported with a probability is true that often: a reliability diagram.
//!
//! Source: DeGroot and Fienberg, *The comparison and evaluation of forecasters*, The Statistician 32, 1983.

use std::fmt::Write as _;

use crate::matrix::interval::interval;

/// Something that is reported with a probability, and whether it is so.
#[derive(Clone, Debug, PartialEq)]
pub struct Claim {
    /// Its full name.
    pub name: String,
    /// What is reported.
    pub probability: f64,
    /// What keeps it from being named; none where it is.
    pub why_not: Option<String>,
    /// Whether it is so.
    pub is_right: bool,
}

/// Where the bins of probability begin; the last ends at 1.
const BINS: [f64; 5] = [0.0, 0.5, 0.8, 0.95, 0.999];

/// The claims of one bin.
#[derive(Clone, Debug, PartialEq)]
struct Bin {
    from: f64,
    to: f64,
    count: usize,
    right: usize,
    /// The mean of what is reported.
    reported: f64,
}

fn bins(claims: &[Claim]) -> Vec<Bin> {
    let ends = BINS.iter().skip(1).copied().chain([f64::INFINITY]);
    let of = |(&from, to): (&f64, f64)| {
        let inside: Vec<&Claim> = claims.iter().filter(|claim| (from..to).contains(&claim.probability)).collect();
        let sum: f64 = inside.iter().map(|claim| claim.probability).sum();
        Bin {
            from,
            to: to.min(1.0),
            count: inside.len(),
            right: inside.iter().filter(|claim| claim.is_right).count(),
            reported: sum / inside.len().max(1) as f64,
        }
    };
    BINS.iter().zip(ends).map(of).filter(|bin| bin.count > 0).collect()
}

/// What was reported in each bin, and how often it was so.
pub fn table(claims: &[Claim]) -> String {
    let mut text = String::from("| probability reported | classes | mean reported | right |\n|---|---:|---:|---|\n");
    for bin in bins(claims) {
        let [low, high] = interval(bin.right, bin.count).map(|bound| 100.0 * bound);
        let Bin { from, to, count, right, reported } = bin;
        writeln!(
            text,
            "| {from} to {to} | {count} | {:.1} % | {right}, {:.1} % [{low:.0}-{high:.0} %] |",
            100.0 * reported,
            100.0 * right as f64 / count as f64
        )
        .expect("a string takes all that is written to it");
    }
    text
}

/// Width and height of the square that the diagram is drawn in, and what is around it.
const SIDE: f64 = 300.0;
const MARGIN: f64 = 50.0;

/// The same as a drawing (SVG): a point for each bin, with the 95 % interval of its share (Clopper, Pearson).
/// Points on the diagonal are what they should be.
pub fn diagram(claims: &[Claim]) -> String {
    let (size, end) = (SIDE + 2.0 * MARGIN, MARGIN + SIDE);
    let x = |p: f64| MARGIN + SIDE * p;
    let y = |p: f64| end - SIDE * p;
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {size} {size}\" width=\"{size}\" \
         font-family=\"sans-serif\" font-size=\"12\">\n\
         <rect width=\"{size}\" height=\"{size}\" fill=\"#fff\"/>\n\
         <rect x=\"{MARGIN}\" y=\"{MARGIN}\" width=\"{SIDE}\" height=\"{SIDE}\" fill=\"none\" stroke=\"#999\"/>\n\
         <line x1=\"{MARGIN}\" y1=\"{end}\" x2=\"{end}\" y2=\"{MARGIN}\" stroke=\"#999\" stroke-dasharray=\"4\"/>\n"
    );
    let mut add = |line: String| text += &(line + "\n");
    for tick in [0.0, 0.2, 0.4, 0.6, 0.8, 1.0] {
        add(format!("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{tick}</text>", x(tick), end + 16.0));
        add(format!("<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{tick}</text>", MARGIN - 6.0, y(tick) + 4.0));
    }
    add(format!("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">probability reported</text>", x(0.5), end + 36.0));
    add(format!(
        "<text x=\"14\" y=\"{0}\" text-anchor=\"middle\" transform=\"rotate(-90 14 {0})\">share that is right</text>",
        y(0.5)
    ));
    for bin in bins(claims) {
        let at = x(bin.reported);
        let [low, high] = interval(bin.right, bin.count).map(y);
        let share = y(bin.right as f64 / bin.count as f64);
        add(format!("<line x1=\"{at:.1}\" y1=\"{low:.1}\" x2=\"{at:.1}\" y2=\"{high:.1}\" stroke=\"#0b62a4\"/>"));
        add(format!("<circle cx=\"{at:.1}\" cy=\"{share:.1}\" r=\"4\" fill=\"#0b62a4\"/>"));
        add(format!("<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>", at - 7.0, share + 4.0, bin.count));
    }
    text + "</svg>\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    fn claims() -> Vec<Claim> {
        let claim = |probability, is_right| Claim { name: String::new(), probability, why_not: None, is_right };
        vec![claim(0.6, true), claim(0.7, false), claim(0.9995, true), claim(1.0, true), claim(0.95, true)]
    }

    #[test]
    fn each_claim_is_in_one_bin() {
        let bins = bins(&claims());
        let counts: Vec<(f64, usize, usize)> = bins.iter().map(|bin| (bin.from, bin.count, bin.right)).collect();
        assert_eq!(counts, [(0.5, 2, 1), (0.95, 1, 1), (0.999, 2, 2)]);
        assert!((bins[0].reported - 0.65).abs() < 1e-12);
    }

    #[test]
    fn the_diagram_has_a_point_for_each_bin() {
        let text = diagram(&claims());
        assert_eq!(text.matches("<circle").count(), 3);
        assert!(table(&claims()).contains("| 0.5 to 0.8 | 2 | 65.0 % | 1, 50.0 % [1-99 %] |"));
    }
}
