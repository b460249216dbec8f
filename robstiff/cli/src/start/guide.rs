//! The page that says how to measure.

use robstiff_identify::plan::first::{First, RAMP};
use robstiff_robots::Description;

/// The page, which loads nothing.
pub fn page(robot: &Description, found: &First) -> String {
    let name = &robot.name;
    let poses = found.visits.len();
    let shares: Vec<String> = RAMP.iter().map(|share| format!("{:.0} N", share * found.force)).collect();
    let shares = shares.join(", ");
    let taken: String = found.assumptions.iter().map(|said| format!("<li>{said}</li>\n")).collect();
    format!(
        "<!DOCTYPE html>
<html lang=\"en\">
<head>
<meta charset=\"utf-8\">
<title>How to measure {name}</title>
<style>
body {{ font: 1rem/1.5 sans-serif; max-width: 42rem; margin: 2rem auto; padding: 0 1rem; }}
li {{ margin: .3rem 0; }}
code {{ background: #eee; padding: 0 .2rem; }}
</style>
</head>
<body>
<h1>How to measure {name}</h1>
<p>You pull at the tool with a known force and read how far the tool moves. {poses} poses take about a day.</p>
<h2>What you need</h2>
<ul>
<li>A force on the tool in a known direction: a weight on a rope, a rope over a pulley, or a chain hoist with a load
cell.</li>
<li>Something that reads how far the tool moves along x, y and z to a few micrometres: three dial gauges on a stand that
does not touch the arm, or a laser tracker.</li>
</ul>
<h2>Before you begin</h2>
<ol>
<li>Check that the arm bears {force:.0} N at the tool in every pose. If not, run <code>robstiff start</code> again with a
smaller <code>--force</code>.</li>
<li>Move slowly to every pose of <code>loads.csv</code>. Nobody but you knows what the arm could hit. Where a pose cannot be
reached, change its angles in the table to those that you take.</li>
<li>Let the arm run for half an hour, so that it is warm. Keep the brakes open and the drives on.</li>
<li>If the force does not act at the tool centre point, or the gauge reads another point, say where in
<code>campaign.yaml</code>.</li>
</ol>
<h2>At every pose</h2>
<ol>
<li>Go to the pose from the same side each time. Wait until nothing moves any more.</li>
<li>Without a load, set the gauges to zero.</li>
<li>Apply the loads of the pose in the order of the table: {shares}, in the direction of <code>Fx Fy Fz</code> along the axes
of the robot's base. Up, then down again: that shows play and friction.</li>
<li>At each load write how far the tool has moved since the zero into <code>dx dy dz</code>, in micrometres, along the axes of the
base.</li>
<li>Write the force that was there into <code>Fx Fy Fz</code>, not the one that was planned. Write the angles that the control
shows into <code>q1</code> and so on.</li>
</ol>
<h2>What makes it good</h2>
<ul>
<li>At one pose, read the same load five times. Half of what these readings differ by, or better their standard deviation,
goes into <code>campaign.yaml</code> as <code>noise</code>. With it, what is left can be told from noise.</li>
<li>Ten poses well read are worth more than thirty in a hurry. The best poses come first: stop when you must, and delete the
rows that you did not measure.</li>
<li>Come back to the first pose at the end. What differs is drift.</li>
</ul>
<h2>Then</h2>
<p><code>robstiff trace campaign.yaml --out found</code> says what gives way, and writes the corrected description.</p>
<h2>How the poses were chosen</h2>
<p>Of many poses and directions of pull, those that together tell most of every compliance that an arm may have and of what may be
wrong with load cell and gauge.</p>
<ul>
{taken}</ul>
</body>
</html>
",
        force = found.force
    )
}
