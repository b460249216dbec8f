//! Our side of `benches/peers`: `peer check` prints the triangles of the first
//! poses, `peer time` the least time of a pass over all poses, in ns a pose.

use std::hint::black_box;
use std::time::Instant;

use robstiff::batch::{self, Grid};
use robstiff_benches::{Rv130hsc, poses, trace, triangle};

const COUNT: usize = 1024;

fn time(name: &str, mut pass: impl FnMut()) {
    let mut least = f64::INFINITY;
    for _ in 0..300 {
        let start = Instant::now();
        pass();
        least = least.min(start.elapsed().as_nanos() as f64 / COUNT as f64);
    }
    println!("{name}\t{least}");
}

fn main() {
    let poses = poses::<5>(COUNT);
    let mut triangles = vec![[0.0; 21]; COUNT];
    if std::env::args().nth(1).as_deref() == Some("check") {
        for batched in [false, true] {
            for (q, out) in poses.iter().zip(&mut triangles) {
                triangle(q, out);
            }
            if batched {
                batch::compliance_triangle(&Rv130hsc, &poses, &mut triangles);
            }
            let name = if batched { "batch" } else { "single" };
            for entry in triangles[..64].as_flattened() {
                println!("{name}\t{entry:e}");
            }
        }
        return;
    }
    let mut traces = vec![0.0; COUNT];
    time("single", || {
        poses.iter().zip(&mut triangles).for_each(|(q, out)| triangle(q, out));
        black_box(&mut triangles);
    });
    time("single, trace only", || {
        poses.iter().zip(&mut traces).for_each(|(q, out)| *out = trace(q));
        black_box(&mut traces);
    });
    time("batch", || {
        batch::compliance_triangle(&Rv130hsc, &poses, &mut triangles);
        black_box(&mut triangles);
    });
    let mut entries = vec![0.0; 21 * COUNT];
    time("batch, by entry", || {
        let mut slices = entries.chunks_exact_mut(COUNT);
        let slices = std::array::from_fn(|_| slices.next().expect("21 slices"));
        batch::compliance_by_entry(&Rv130hsc, &poses, slices);
        black_box(&mut entries);
    });
    time("batch, trace only", || {
        batch::translational_trace(&Rv130hsc, &poses, &mut traces);
        black_box(&mut traces);
    });
    time("batch, by block", || {
        batch::compliance_blocks(&Rv130hsc, &poses, |_, entries| {
            black_box(entries);
        });
    });
    let poses: Vec<_> = poses.iter().map(|q| q.map(|x| x as f32)).collect();
    let mut triangles = vec![[0.0; 21]; COUNT];
    time("batch, f32", || {
        batch::compliance_triangle(&Rv130hsc, &poses, &mut triangles);
        black_box(&mut triangles);
    });
    time("batch, by block, f32", || {
        batch::compliance_blocks(&Rv130hsc, &poses, |_, entries| {
            black_box(entries);
        });
    });
    let turns: Vec<f64> = (0..64).map(|i| 0.05 * i as f64).collect();
    let coordinates = [64, 4, 4, 1, 1].map(|length| &turns[..length]);
    let mut tables = vec![0.0; Grid::table_len(&coordinates)];
    let grid = Grid::new(coordinates, &mut tables);
    let mut triangles = vec![[0.0; 21]; COUNT];
    time("grid", || {
        batch::compliance_triangle(&Rv130hsc, grid, &mut triangles);
        black_box(&mut triangles);
    });
    time("grid, by block", || {
        batch::compliance_blocks(&Rv130hsc, grid, |_, entries| {
            black_box(entries);
        });
    });
    time("grid, trace only", || {
        batch::translational_trace(&Rv130hsc, grid, &mut traces);
        black_box(&mut traces);
    });
}
