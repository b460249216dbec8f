//! Machining with a robot arm that yields.
//!
//! - [`inverse`], [`path`]: the joint coordinates of a pose of the tool, and of a tool path;
//! - [`nc`]: programs of machine tools, G-code and APT, move by move;
//! - [`milling`], [`stability`]: the force of an end mill, and the depth of cut at which the arm
//!   chatters, by direction of feed and spindle speed;
//! - [`engagement`]: what is cut where along a path, from the stock;
//! - [`deviation`], [`compensation`]: how far a cut pushes the tool off a path, and the path that
//!   makes up for it;
//! - [`grade`]: tolerance grades;
//! - [`online`]: correcting the joint targets while cutting;
//! - [`cell`]: robot, spindle, tools and workpiece in one file;
//! - [`program`]: programs of KUKA, ABB and FANUC controllers, written, read, and changed in place;
//! - [`controller`]: what a controller makes of positions with its nominal model, programs of paths,
//!   and programs corrected;
//! - [`map`]: stiffness and deviation over joint space, planes and boxes, and where a workpiece
//!   is best put.

pub mod cell;
pub mod compensation;
pub mod controller;
pub mod deviation;
pub mod engagement;
mod golden;
pub mod grade;
pub mod inverse;
pub mod map;
pub mod milling;
pub mod nc;
pub mod online;
pub mod path;
pub mod program;
pub mod stability;
