//! A campaign as something that can be searched.

use robstiff_robots::Description;

use crate::campaign::holdout::training_of;
use crate::campaign::{Campaign, Data};
use crate::effects::{Scene, Shapes, What};
use crate::model::Weight;
use crate::observe::Observation;
use crate::observe::clamped::Clamped;
use crate::observe::displacement::Displacement;
use crate::observe::position::Position;
use crate::select::Engine;

/// What a campaign reads, and what it can show.
pub struct Case<'c> {
    /// The readings.
    pub observation: Box<dyn Observation + 'c>,
    /// What they can show.
    pub scene: Scene<'c>,
    /// Which blocks are fitted to.
    pub training: Vec<bool>,
    /// What errors are reported of one by one: the names of poses, or of clamped axes.
    pub groups: Vec<String>,
    /// The group of each row.
    pub group: Vec<usize>,
    /// The noise of one axis of a row, where it is declared (m, rad).
    pub noise: Option<f64>,
    /// The joints (from 1) whose angle is read behind the gear.
    pub encoders: Vec<usize>,
    /// Of clamped axes, the torque of each row over the largest of its axis; of positions, the payload over the
    /// heaviest.
    loads: Vec<f64>,
}

impl<'c> Case<'c> {
    /// A campaign, on the arm of a description that need not be its own.
    pub fn new(campaign: &'c Campaign, robot: &'c Description) -> Self {
        let declared = campaign.noise_of_reading();
        match &campaign.data {
            Data::Displacement(data) => {
                let observation = Displacement::new(robot, data);
                let loaded = observation.loaded(observation.world(), &[], &[]);
                let torque = largest(&loaded.torques);
                let force = loaded.wrenches.iter().map(|w| w.fixed_rows::<3>(0).norm()).fold(0.0, f64::max);
                let warmth = span(data.rows.iter().filter_map(|row| row.temperature));
                let encoders = observation.encoders.clone();
                // Of a row that shares its unloaded reading with no other, both are in its noise.
                let alone = data.visits.len() >= data.rows.len();
                let noise = declared.map(|noise| if alone { noise * core::f64::consts::SQRT_2 } else { noise });
                let scene = scene(robot, What::Displacements, &observation, (torque, force), warmth, Vec::new());
                let training = training_of(data.poses.len(), campaign);
                let observation = Box::new(observation);
                let (groups, group) = (data.poses.clone(), observation.readings().block.clone());
                Self { observation, scene, training, groups, group, noise, encoders, loads: Vec::new() }
            }
            Data::Position(data) => {
                let observation = Position::new(robot, data);
                let warmth = span(data.rows.iter().filter_map(|row| row.temperature));
                let load = if observation.payloads { 1.0 } else { 0.0 };
                let torque = largest(&observation.torques());
                let scene = scene(robot, What::Positions, &observation, (torque, load), warmth, Vec::new());
                let training = training_of(data.poses.len(), campaign);
                let observation = Box::new(observation);
                let (groups, group) = (data.poses.clone(), observation.readings().block.clone());
                let (noise, encoders) = (declared, Vec::new());
                let loads = observation.loads().to_vec();
                Self { observation, scene, training, groups, group, noise, encoders, loads }
            }
            Data::Clamped(rows) => {
                let observation = Clamped::new(robot, rows);
                let mut torque = vec![0.0_f64; robot.joints.len()];
                rows.iter().for_each(|row| torque[row.axis - 1] = torque[row.axis - 1].max(row.torque.abs()));
                let axes = observation.axes.clone();
                let groups = axes.iter().map(|axis| format!("axis {axis}")).collect();
                let (blocks, group) = (observation.readings().blocks, observation.readings().visit.clone());
                let training = vec![true; blocks];
                let scene = scene(robot, What::Clamped, &observation, (torque, 0.0), 0.0, axes);
                let loads =
                    rows.iter().map(|row| row.torque / scene.torque[row.axis - 1].max(f64::MIN_POSITIVE)).collect();
                let (observation, noise) = (Box::new(observation), campaign.noise.rotation);
                Self { observation, scene, training, groups, group, noise, encoders: Vec::new(), loads }
            }
        }
    }

    /// The campaign, ready to be searched.
    pub fn engine<'e>(&'e self, robot: &'e Description) -> Engine<'e>
    where
        'c: 'e,
    {
        Engine::new(&*self.observation, robot, self.scene.clone(), self.training.clone(), self.noise)
    }

    /// Whether two rows of a visit, of positions of a pose, were read under the same load, but for a part of the usual one.
    pub fn is_same_load(&self, one: usize, other: usize, part: f64) -> bool {
        let readings = self.observation.readings();
        match self.scene.what {
            What::Displacements => (readings.force[one] - readings.force[other]).norm() < part,
            What::Clamped | What::Positions => (self.loads[one] - self.loads[other]).abs() < part,
        }
    }

    /// The poses that are held out.
    pub fn held_out(&self) -> Vec<String> {
        let is_held_out = |group: usize| self.rows(false).iter().any(|&row| self.group[row] == group);
        (0..self.groups.len()).filter(|&group| is_held_out(group)).map(|group| self.groups[group].clone()).collect()
    }

    /// The rows of the blocks that are fitted to, or of the others.
    pub fn rows(&self, fitted: bool) -> Vec<usize> {
        let readings = self.observation.readings();
        (0..readings.rows()).filter(|&row| self.training[readings.block[row]] == fitted).collect()
    }
}

/// The largest torque on each joint.
fn largest(torques: &[Vec<f64>]) -> Vec<f64> {
    torques.iter().map(|of| of.iter().fold(0.0_f64, |most, torque| most.max(torque.abs()))).collect()
}

fn scene<'c>(
    robot: &'c Description,
    what: What,
    observation: &dyn Observation,
    (torque, force): (Vec<f64>, f64),
    warmth: f64,
    axes: Vec<usize>,
) -> Scene<'c> {
    let readings = observation.readings();
    let mut scene = Scene {
        robot,
        what,
        kinds: robot.joints.iter().map(|joint| joint.kind).collect(),
        compliance: robot.joints.iter().map(|joint| joint.compliance()).collect(),
        middle: 0.0,
        torque,
        force,
        weight: Weight::of(robot),
        lines: readings.lines.clone(),
        visit: readings.visit.clone(),
        visits: readings.visit.iter().max().map_or(0, |last| last + 1),
        warmth,
        shapes: Shapes::default(),
        axes,
    };
    scene.learn_middle();
    scene
}

/// From the least to the largest of some numbers; zero of none.
fn span(numbers: impl Iterator<Item = f64>) -> f64 {
    let ends = numbers.fold(None, |ends: Option<[f64; 2]>, number| {
        Some(ends.map_or([number; 2], |[least, most]| [least.min(number), most.max(number)]))
    });
    ends.map_or(0.0, |[least, most]| most - least)
}
