//! Ours against ours: generated against generic, one by one against abreast.
//!
//! Only the ratios of one run mean anything.
#![allow(missing_docs, reason = "the macros of criterion make functions without")]

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use robstiff::batch::{self, Grid};
use robstiff::nalgebra::{Matrix4, Matrix6, SMatrix, Vector3, Vector6};
use robstiff::{Dual, Robot};
use robstiff_benches::{self as measured, Rv130hsc, WRENCH, poses};

const COUNT: usize = 1024;

/// One call a pose.
fn single(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("single, 1024 poses");
    group.throughput(Throughput::Elements(COUNT as u64));
    let poses = poses::<5>(COUNT);
    let generic = measured::generic();
    macro_rules! each {
        ($name:literal, $out:expr, |$q:ident, $into:ident| $call:expr) => {
            let mut $into = $out;
            group.bench_function($name, |bencher| {
                bencher.iter(|| {
                    for $q in &poses {
                        $call;
                        black_box(&mut $into);
                    }
                });
            });
        };
    }
    each!("sines and cosines", [(0.0, 0.0); 5], |q, out| measured::five_angles(&q.data.0[0], &mut out));
    each!("sines and cosines, platform", [(0.0, 0.0); 5], |q, out| out = q.data.0[0].map(f64::sin_cos));
    each!("transform", Matrix4::zeros(), |q, out| measured::transform(q, &mut out));
    each!("jacobian", SMatrix::zeros(), |q, out| measured::jacobian(q, &mut out));
    each!("deflection", Vector6::zeros(), |q, out| measured::deflection(q, &WRENCH, &mut out));
    each!("trace", 0.0, |q, out| out = measured::trace(q));
    each!("compliance", Matrix6::zeros(), |q, out| measured::compliance(q, &mut out));
    each!("compliance, generic", Matrix6::zeros(), |q, out| out = generic.compliance(q));
    each!("compliance with derivatives", Matrix6::zeros(), |q, out| out = Rv130hsc.compliance(&Dual::variables(*q)));
    group.finish();
}

/// Slices of poses.
fn batches(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("batch, 1024 poses");
    group.throughput(Throughput::Elements(COUNT as u64));
    let poses = poses::<5>(COUNT);
    macro_rules! batch {
        ($name:literal, $zero:expr, |$poses:ident, $out:ident| $call:expr) => {
            let ($poses, mut results) = (&poses, vec![$zero; COUNT]);
            group.bench_function($name, |bencher| {
                bencher.iter(|| {
                    let $out = &mut results;
                    $call;
                    black_box(&mut results);
                });
            });
        };
    }
    batch!("compliance", Matrix6::zeros(), |q, out| batch::compliance(&Rv130hsc, q, out));
    batch!("triangle", [0.0; 21], |q, out| batch::compliance_triangle(&Rv130hsc, q, out));
    batch!("trace", 0.0, |q, out| batch::translational_trace(&Rv130hsc, q, out));
    batch!("along a direction", 0.0, |q, out| batch::directional_compliance(&Rv130hsc, q, &Vector3::x(), out));
    batch!("deflection", Vector6::zeros(), |q, out| batch::deflection(&Rv130hsc, q, &WRENCH, out));
    let single: Vec<_> = poses.iter().map(|q| q.map(|x| x as f32)).collect();
    let wrenches = vec![WRENCH; COUNT];
    batch!("deflection, a wrench a pose", Vector6::zeros(), |q, out| batch::deflections(&Rv130hsc, q, &wrenches, out));
    batch!("blocks", (), |q, _out| batch::compliance_blocks(&Rv130hsc, q, |_, entries| {
        black_box(entries);
    }));
    batch!("triangle, f32", [0.0; 21], |_q, out| batch::compliance_triangle(&Rv130hsc, &single, out));
    batch!("trace, f32", 0.0, |_q, out| batch::translational_trace(&Rv130hsc, &single, out));
    batch!("blocks, f32", (), |_q, _out| batch::compliance_blocks(&Rv130hsc, &single, |_, entries| {
        black_box(entries);
    }));
    group.finish();
}

/// Grids in joint space, of as many poses.
fn grids(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("grid, 1024 poses");
    group.throughput(Throughput::Elements(COUNT as u64));
    let turns: Vec<f64> = (0..64).map(|i| 0.05 * i as f64).collect();
    // The first joint has 64 coordinates, or one; or both of the first have few.
    let shapes =
        [("rows of 64", [64, 4, 4, 1, 1]), ("first joint fixed", [1, 64, 4, 4, 1]), ("rows of 8", [8, 8, 4, 4, 1])];
    for (name, lengths) in shapes {
        let coordinates = lengths.map(|length| &turns[..length]);
        let mut tables = vec![0.0; Grid::table_len(&coordinates)];
        let grid = Grid::new(coordinates, &mut tables);
        let (mut triangles, mut traces) = (vec![[0.0; 21]; COUNT], vec![0.0; COUNT]);
        group.bench_function(format!("triangle, {name}"), |bencher| {
            bencher.iter(|| {
                batch::compliance_triangle(&Rv130hsc, grid, &mut triangles);
                black_box(&mut triangles);
            });
        });
        group.bench_function(format!("blocks, {name}"), |bencher| {
            bencher.iter(|| {
                batch::compliance_blocks(&Rv130hsc, grid, |_, entries| {
                    black_box(entries);
                });
            });
        });
        group.bench_function(format!("trace, {name}"), |bencher| {
            bencher.iter(|| {
                batch::translational_trace(&Rv130hsc, grid, &mut traces);
                black_box(&mut traces);
            });
        });
    }
    group.finish();
}

/// One core against all: so many poses that waking the others costs little, and
/// results that still fit the cache.
fn cores(criterion: &mut Criterion) {
    const COUNT: usize = 65536;
    let mut group = criterion.benchmark_group("cores, 65536 poses");
    group.throughput(Throughput::Elements(COUNT as u64));
    let poses = poses::<5>(COUNT);
    let (mut triangles, mut traces) = (vec![[0.0; 21]; COUNT], vec![0.0; COUNT]);
    macro_rules! cores {
        ($name:literal, $quantity:ident, $out:ident) => {
            group.bench_function(concat!($name, ", one"), |bencher| {
                bencher.iter(|| {
                    batch::$quantity(&Rv130hsc, &poses, &mut $out);
                    black_box(&mut $out);
                });
            });
            group.bench_function(concat!($name, ", all"), |bencher| {
                bencher.iter(|| {
                    batch::parallel::$quantity(&Rv130hsc, &poses, &mut $out);
                    black_box(&mut $out);
                });
            });
        };
    }
    cores!("triangle", compliance_triangle, triangles);
    cores!("trace", translational_trace, traces);
    group.finish();
}

criterion_group!(ratios, single, batches, grids, cores);
criterion_main!(ratios);
