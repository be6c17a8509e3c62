//! Plates with a crack, pulled apart slowly: the specimens of the checks of fracture, and the stress intensity of
//! their load.
//!
//! ```text
//!   ▀▀▀▀▀▀▀▀▀  grip, moves along +v       v
//!   ░░░░░░░░░                             │    The axes u and v belong to the plate.
//!   ░░░───░░░  crack                      └─ u The lattice of voxels is turned against them.
//!   ░░░░░░░░░
//!   ▄▄▄▄▄▄▄▄▄  grip, moves along −v
//! ```
//!
//! A plate starts in static equilibrium at a part of its expected load, so that no vibration adds to the load. The
//! stress intensity K follows from the measured load F per depth: K = k F, with k = √(E' / 2 · dC/dA) [Irwin 1957].
//! The compliance C as a function of the crack area A comes from static solutions on fine uniform meshes that are not
//! turned.

use super::bar::{POISSON, plane_strain, still};
use super::statics::Statics;
use crate::report::Progress;
use anyhow::{Result, ensure};
use fuwafuwa::glam::DVec3;
use fuwafuwa::inspect::{Elasticity, Node, voxel_around};
use fuwafuwa::{
    Blade, Damping, Dim, Dim2, Dim3, DimVector, Event, Grading, Law, Material, NodeId, Point,
    Rotation, SoftBody, Vec3, VoxelGrid, World,
};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::RangeInclusive;

/// Width [m] to which the number of voxels across a plate refers.
pub const WIDTH: f64 = 0.5;
/// Half of the distance between the grips of [`Specimen::Cantilever`] [m].
const GRIP: f64 = 0.125;
/// Young's modulus of the plates [Pa].
const YOUNG: f64 = 5000.0;
/// Toughness of the plates [Pa √m]. Strains at failure are some percent, so linear theory holds.
pub const TOUGHNESS: f64 = 30.0;
/// Distance between a crack and the nearest row of voxel centres [voxels]. It decides between which rows an ambiguous
/// crack runs.
const BESIDE: f64 = 0.08;

/// Shape and grips of a plate.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum Specimen {
    /// Plate 0.5 m wide and 1 m high with a crack in its centre: half length [m], and angle to the u axis [°].
    Centre { half: f64, angle: f64 },
    /// Plate 0.5 m wide and 1 m high with a crack from its left edge. The grips do not turn.
    Edge { length: f64 },
    /// Square plate 0.75 m wide with a crack of 0.3125 m from its left edge: two short cantilevers. The grips hold
    /// the left edge beside its middle third, so that growth of the crack lowers K.
    Cantilever,
    /// Strip 1.5 m long and 0.375 m high, held at its upper and lower surface, with a crack of 0.5 m: K does not depend on
    /// the crack length.
    Strip,
    /// Plate 1 m wide and 2 m high with a crack from its left edge. The grips do not turn.
    WideEdge { length: f64 },
    /// Plate 1 m wide and 2 m high with a slot from its left edge to this depth [m]. The end of the slot is a half circle
    /// of this radius [m].
    Slot { depth: f64, radius: f64 },
}

impl Specimen {
    /// Plate with a crack of half its width in its centre, square to the pull.
    pub const CENTRE: Self = Self::Centre {
        half: 0.25 * WIDTH,
        angle: 0.0,
    };

    /// Height of [`Specimen::Strip`] [m].
    pub const STRIP_HEIGHT: f64 = 0.375;

    /// Name in the table.
    pub fn name(self) -> String {
        match self {
            Self::Centre { angle: 0.0, .. } => "centre".into(),
            Self::Centre { angle, .. } => format!("oblique {angle}°"),
            Self::Edge { length } => format!("edge {}", length / WIDTH),
            Self::WideEdge { length } => format!("wide edge {length}"),
            Self::Cantilever => "cantilever".into(),
            Self::Strip => "strip".into(),
            Self::Slot { .. } => "slot".into(),
        }
    }

    /// Width and height, with the grips [m].
    pub fn size(self) -> [f64; 2] {
        match self {
            Self::Centre { .. } | Self::Edge { .. } => [WIDTH, 1.0],
            Self::Cantilever => [0.75, 0.75],
            Self::Strip => [1.5, Self::STRIP_HEIGHT],
            Self::WideEdge { .. } | Self::Slot { .. } => [1.0, 2.0],
        }
    }

    /// Ends of the crack [m], measured from the centre of the plate, with all tips moved forwards by `growth`. `None`
    /// if there is no crack.
    fn crack(self, growth: f64) -> Option<[[f64; 2]; 2]> {
        let edge = -0.5 * self.size()[0];
        let from_edge = |length: f64| Some([[edge - 0.1, 0.0], [edge + length + growth, 0.0]]);
        match self {
            Self::Centre { half, angle } => {
                let (sine, cosine) = angle.to_radians().sin_cos();
                let [x, y] = [cosine, sine].map(|share| share * (half + growth));
                Some([[-x, -y], [x, y]])
            }
            Self::Slot { .. } => None,
            _ => from_edge(self.length()),
        }
    }

    /// Length of the crack before it grows: half of it for a crack in the centre [m].
    pub fn length(self) -> f64 {
        match self {
            Self::Centre { half, .. } => half,
            Self::Edge { length } | Self::WideEdge { length } => length,
            Self::Cantilever => 0.3125,
            Self::Strip => 0.5,
            Self::Slot { depth, .. } => depth,
        }
    }

    /// Length of a crack with these tips, in the sense of [`Specimen::length`] [m].
    fn length_to(self, tips: &[[f64; 2]]) -> f64 {
        match (self, tips) {
            (Self::Centre { .. }, &[a, b]) => 0.5 * (a[0] - b[0]).hypot(a[1] - b[1]),
            (_, &[tip]) => tip[0] + 0.5 * self.size()[0],
            _ => self.length(),
        }
    }

    /// Number of crack tips.
    fn tips(self) -> usize {
        match self {
            Self::Centre { .. } => 2,
            Self::Slot { .. } => 0,
            _ => 1,
        }
    }

    fn is_solid(self, [u, v]: [f64; 2]) -> bool {
        let [width, height] = self.size();
        let is_inside = u.abs() < 0.5 * width + 1e-7 && v.abs() < 0.5 * height + 1e-7;
        let is_slot = match self {
            Self::Slot { depth, radius } => {
                let beyond = (u + 0.5 * width - (depth - radius)).max(0.0);
                beyond.hypot(v) < radius
            }
            _ => false,
        };
        is_inside && !is_slot
    }

    /// Returns the direction in which the grip at a place moves along v: 1, −1, or 0 if there is no grip. `voxel` is the
    /// size of the voxels [m].
    ///
    /// Grips hold nodes of the surface. Deeper grips would end inside of large elements, and hold less than their depth. On
    /// average over the steps of a turned surface, the nodes within half a voxel lie on the nominal surface.
    fn grip(self, [u, v]: [f64; 2], voxel: f64) -> f64 {
        let [width, height] = self.size();
        let is_held = match self {
            Self::Cantilever => {
                u < -0.5 * (width - voxel) - 1e-7 && v.abs() > GRIP - 0.5 * voxel - 1e-7
            }
            _ => v.abs() > 0.5 * (height - voxel) + 1e-7,
        };
        if is_held { v.signum() } else { 0.0 }
    }
}

/// Material and lattice of a plate.
#[derive(Copy, Clone, Debug)]
pub struct Setting {
    /// Voxels across 0.5 m.
    pub voxels: usize,
    /// Angle by which the lattice is turned against the plate [°].
    pub turned: f64,
    /// Poisson's ratio.
    pub poisson: f64,
    /// Tensile strength [Pa].
    pub strength: f64,
    /// Thickness of the plate [m]; ignored in 2D.
    pub thickness: f64,
    /// Distance by which all crack tips are moved forwards [m].
    pub growth: f64,
    /// Mass damping [1/s].
    pub damping: f32,
    /// Grading of the elements.
    pub grading: Grading,
}

impl Setting {
    /// Returns a lattice with a number of voxels across 0.5 m. Its strength excludes failures away from crack tips.
    pub fn new(voxels: usize, poisson: f64) -> Self {
        Self {
            voxels,
            turned: 0.0,
            poisson,
            strength: 1e5,
            thickness: 0.0,
            growth: 0.0,
            damping: 0.0,
            grading: Grading::Graded,
        }
    }

    /// Elastic constants.
    pub fn elasticity(&self) -> Elasticity {
        Elasticity {
            young: YOUNG,
            poisson: self.poisson,
        }
    }

    /// Fracture energy in plane strain [J/m²].
    pub fn fracture_energy(&self) -> f64 {
        TOUGHNESS * TOUGHNESS / plane_strain(self.elasticity())
    }
}

/// Place of the plate's axes in the lattice.
#[derive(Copy, Clone, Debug)]
struct Frame {
    /// Centre of the plate in the lattice [m].
    middle: DVec3,
    /// Unit vectors of the axes u and v in the lattice.
    axes: [DVec3; 2],
    voxel: f64,
}

impl Frame {
    /// Returns the coordinates u and v of a place in the lattice [m].
    fn plate(&self, lattice: DVec3) -> [f64; 2] {
        self.axes.map(|axis| axis.dot(lattice - self.middle))
    }

    /// Returns the coordinates u and v of a lattice point [m].
    fn plate_of(&self, point: Point) -> [f64; 2] {
        self.plate(DVec3::from(point.map(f64::from)) * self.voxel)
    }
}

/// Plate with its crack.
pub struct Plate<D: Dim> {
    specimen: Specimen,
    setting: Setting,
    /// Body, at rest, with the axes of the world along those of the lattice.
    pub body: SoftBody<D>,
    frame: Frame,
    /// Length of the crack that was cut, in the sense of [`Specimen::length`] [m].
    pub length: f64,
    /// Thickness; 1 in 2D [m].
    pub thickness: f64,
}

impl<D: PlateDim> Plate<D> {
    /// Builds a plate and cuts its crack.
    pub fn new(specimen: Specimen, setting: Setting) -> Result<Self> {
        let voxel = WIDTH / setting.voxels as f64;
        let (sine, cosine) = setting.turned.to_radians().sin_cos();
        let [width, height] = specimen.size();
        // Even numbers of voxels put the centre on a lattice point.
        let count = |extent: f64| 2 * (0.5 * extent / voxel - 1e-6).ceil() as usize;
        let box_size = [
            count(width * cosine + height * sine),
            count(width * sine + height * cosine),
        ];
        let depth = D::depth((setting.thickness / voxel).round().max(1.0) as usize);
        let frame = Frame {
            middle: DVec3::new(box_size[0] as f64, box_size[1] as f64, 0.0) * (0.5 * voxel),
            axes: [
                DVec3::new(cosine, sine, 0.0),
                DVec3::new(-sine, cosine, 0.0),
            ],
            voxel,
        };
        let size = [box_size[0], box_size[1], depth];
        let grid = VoxelGrid::<D>::from_fn(size, voxel as f32, |[x, y, _]| {
            let centre = DVec3::new(f64::from(x) + 0.5, f64::from(y) + 0.5, 0.0) * voxel;
            u8::from(specimen.is_solid(frame.plate(centre)))
        })?;
        let material = Material {
            elasticity: setting.elasticity(),
            toughness: TOUGHNESS as f32,
            strength: setting.strength as f32,
            strength_scatter: 0.0,
            damping: Damping {
                mass: setting.damping,
                ..Damping::default()
            },
            ..Material::default()
        };
        let mut plate = Self {
            specimen,
            setting,
            body: SoftBody::with_options(grid, &[material], Law::default(), setting.grading)?,
            frame,
            length: specimen.length(),
            thickness: if D::N == 3 { depth as f64 * voxel } else { 1.0 },
        };
        if let Some(crack) = specimen.crack(setting.growth) {
            plate.cut(crack)?;
        }
        Ok(plate)
    }

    /// Cuts a crack and measures its length from one unsplit node at its end to the other.
    fn cut(&mut self, ends: [[f64; 2]; 2]) -> Result<()> {
        let Frame {
            middle,
            axes,
            voxel,
        } = self.frame;
        let along = DVec3::new(ends[1][0] - ends[0][0], ends[1][1] - ends[0][1], 0.0).normalize();
        let beside = DVec3::new(-along.y, along.x, 0.0) * BESIDE * voxel;
        let [from, to] =
            ends.map(|[u, v]| middle + axes[0] * (u + beside.x) + axes[1] * (v + beside.y));
        let (below, depth) = (-DVec3::Z * voxel, self.thickness + 2.0 * voxel);
        let blade = D::blade(from + below, to - from, depth);
        let report = self.body.cut(&blade);
        let split: BTreeSet<Point> = { report.split_nodes.iter() }
            .map(|at| {
                let at = at.to_vec3().as_dvec3() / voxel;
                at.to_array().map(|k| k.round() as i32)
            })
            .collect();
        // Faces that the blade crosses are edges of the lattice. Points at the end of a single such edge are the tips,
        // unless they lie at the surface.
        let mut edges: BTreeMap<Point, usize> = BTreeMap::new();
        let grid = self.body.grid();
        let centre =
            |[x, y, _]: Point| DVec3::new(f64::from(x) + 0.5, f64::from(y) + 0.5, 0.0) * voxel;
        for low in grid.voxels().filter(|low| low[2] == 0) {
            for axis in 0..2 {
                let mut high = low;
                high[axis] += 1;
                let is_crossed = grid.is_solid(low)
                    && grid.is_solid(high)
                    && crosses([from, to], [centre(low), centre(high)]);
                if is_crossed {
                    let mut end = high;
                    *edges.entry(end).or_default() += 1;
                    end[1 - axis] += 1;
                    *edges.entry(end).or_default() += 1;
                }
            }
        }
        let is_inner = |at: Point| (0..4).all(|k| grid.is_solid(voxel_around::<Dim2>(at, k)));
        let ends: Vec<Point> = { edges.iter() }
            .filter(|(at, count)| **count == 1 && is_inner(**at))
            .map(|(at, _)| *at)
            .collect();
        ensure!(
            ends.len() == self.specimen.tips(),
            "the crack of `{}` has {} tips",
            self.specimen.name(),
            ends.len()
        );
        let expected = edges.keys().filter(|at| !ends.contains(at));
        let layer: BTreeSet<Point> = split.into_iter().filter(|at| at[2] == 0).collect();
        ensure!(
            expected.copied().collect::<BTreeSet<Point>>() == layer,
            "the crack of `{}` does not split the nodes along its line",
            self.specimen.name()
        );
        let tips: Vec<[f64; 2]> = ends.iter().map(|&at| self.frame.plate_of(at)).collect();
        self.length = self.specimen.length_to(&tips);
        Ok(())
    }

    /// Returns the direction in which the grip at a node moves along v; see [`Specimen::grip`].
    fn grip(&self, node: Node) -> f64 {
        let place = self.frame.plate_of(node.at);
        self.specimen.grip(place, self.frame.voxel)
    }

    /// Returns the nodes in grips with the direction in which their grip moves along v.
    fn held(&self) -> Vec<(NodeId, f64)> {
        let nodes = self.body.mesh().nodes();
        let moves = nodes.map(|(id, node)| (id, self.grip(node)));
        moves.filter(|(_, way)| *way != 0.0).collect()
    }

    /// Returns the static solution under grips that are 1 m farther apart, by linear theory.
    pub fn stretched(&self, progress: &Progress) -> Result<Stretched> {
        let mesh = self.body.mesh();
        let statics = Statics::new(mesh, self.setting.elasticity(), |node, _| {
            self.grip(node) != 0.0
        });
        let mut given = vec![0.0; mesh.node_capacity() * D::N];
        for (id, way) in self.held() {
            for axis in 0..D::N {
                given[id.index() * D::N + axis] = 0.5 * way * self.frame.axes[1][axis];
            }
        }
        let moved = statics.solve_displaced(&given, progress)?;
        let size = if D::N == 3 { self.frame.voxel } else { 1.0 };
        let stiffness = 2.0 * statics.energy(&moved) * size / self.thickness;
        Ok(Stretched { moved, stiffness })
    }

    /// Returns the compliance per depth under grips [1/Pa].
    fn compliance(&self, progress: &Progress) -> Result<f64> {
        Ok(1.0 / self.stretched(progress)?.stiffness)
    }

    /// Returns the compliance per depth under a uniform tension of the ends, which can turn freely [1/Pa].
    fn free_compliance(&self, progress: &Progress) -> Result<f64> {
        let mesh = self.body.mesh();
        let size = self.body.grid().size();
        // Three fixed coordinates prevent rigid motions, and carry no load.
        let middle = size[0] / 2;
        let statics = Statics::new(mesh, self.setting.elasticity(), |node, axis| {
            let is_end = node.at[1] == 0 || node.at[1] == size[1] && axis == 0;
            node.at[0] == middle && is_end
        });
        let ends = mesh.nodes().filter(|(_, node)| node.at[1] % size[1] == 0);
        let mut rows: [Vec<(i32, NodeId)>; 2] = [Vec::new(), Vec::new()];
        for (id, node) in ends {
            rows[usize::from(node.at[1] > 0)].push((node.at[0], id));
        }
        let mut load = vec![0.0; mesh.node_capacity() * D::N];
        for (row, way) in rows.iter_mut().zip([-1.0, 1.0]) {
            row.sort_unstable();
            for pair in row.windows(2) {
                let share = f64::from(pair[1].0 - pair[0].0) / f64::from(size[0]);
                for (_, id) in pair {
                    load[id.index() * D::N + 1] += 0.5 * way * share;
                }
            }
        }
        let moved = statics.solve(&load, vec![0.0; load.len()], progress)?;
        Ok(load
            .iter()
            .zip(&moved)
            .map(|(load, moved)| load * moved)
            .sum())
    }
}

/// Returns whether the segment from one voxel centre to another crosses a crack, both given by their ends.
fn crosses(crack: [DVec3; 2], centres: [DVec3; 2]) -> bool {
    let side = |[from, to]: [DVec3; 2], at: DVec3| (to - from).cross(at - from).z > 0.0;
    side(crack, centres[0]) != side(crack, centres[1])
        && side(centres, crack[0]) != side(centres, crack[1])
}

/// Dimension of a plate.
pub trait PlateDim: Dim {
    /// Returns a blade from a corner along `reach`, with a depth along the third axis [m].
    fn blade(corner: DVec3, reach: DVec3, depth: f64) -> Blade<Self>;
}

impl PlateDim for Dim2 {
    fn blade(corner: DVec3, reach: DVec3, _: f64) -> Blade<Self> {
        let [from, to] = [corner, corner + reach].map(|at| at.as_vec3().truncate());
        Blade::segment(from, to)
    }
}

impl PlateDim for Dim3 {
    fn blade(corner: DVec3, reach: DVec3, depth: f64) -> Blade<Self> {
        Blade::parallelogram(corner.as_vec3(), reach.as_vec3(), Vec3::Z * depth as f32)
    }
}

/// Static solution under grips that are 1 m farther apart.
pub struct Stretched {
    /// Displacement of every coordinate, in lattice axes.
    pub moved: Vec<f64>,
    /// Load per depth [N/m] at an opening of 1 m.
    pub stiffness: f64,
}

/// Compliance per depth of a specimen as a function of its crack length, for the stress intensity of its load.
#[derive(Copy, Clone, Debug)]
pub struct Intensity {
    /// Crack lengths [m], and compliances there [1/Pa].
    points: [(f64, f64); 4],
    /// E' / 2 over the number of crack tips [Pa].
    factor: f64,
}

/// Voxels across 0.5 m of the two lattices from which a compliance is extrapolated to the continuum.
const FINE: [usize; 2] = [32, 64];
/// Change of the crack length between two points of an [`Intensity`] [m].
const GROWTH: f64 = 2.0 * WIDTH / 32.0;

impl Intensity {
    /// Computes the compliance under grips, on fine uniform meshes.
    pub fn of(specimen: Specimen, poisson: f64, progress: &Progress) -> Result<Self> {
        let [coarse, fine] = FINE.map(|voxels| {
            let setting = Setting {
                grading: Grading::Uniform,
                ..Setting::new(voxels, poisson)
            };
            Self::on(specimen, setting, |plate| plate.compliance(progress))
        });
        Ok(coarse?.refined(&fine?))
    }

    /// Computes the compliance on the graded mesh of the engine, with a number of voxels across 0.5 m.
    pub fn on_graded_mesh(specimen: Specimen, voxels: usize, progress: &Progress) -> Result<Self> {
        let setting = Setting::new(voxels, POISSON);
        Self::on(specimen, setting, |plate| plate.compliance(progress))
    }

    /// As [`Intensity::of`], for ends without grips under uniform tension.
    pub fn with_free_ends(specimen: Specimen, progress: &Progress) -> Result<Self> {
        let [coarse, fine] = FINE.map(|voxels| {
            let setting = Setting {
                grading: Grading::Uniform,
                ..Setting::new(voxels, POISSON)
            };
            Self::on(specimen, setting, |plate| plate.free_compliance(progress))
        });
        Ok(coarse?.refined(&fine?))
    }

    fn on(
        specimen: Specimen,
        mut setting: Setting,
        compliance: impl Fn(&Plate<Dim2>) -> Result<f64>,
    ) -> Result<Self> {
        let mut points = [(0.0, 0.0); 4];
        for (point, steps) in points.iter_mut().zip([-1.5, -0.5, 0.5, 1.5]) {
            setting.growth = steps * GROWTH;
            let plate = Plate::new(specimen, setting)?;
            *point = (plate.length, compliance(&plate)?);
        }
        let factor = 0.5 * plane_strain(setting.elasticity()) / specimen.tips() as f64;
        Ok(Self { points, factor })
    }

    /// Extrapolates from this lattice and one with voxels of half the size. The error of a compliance is proportional to
    /// the size of the voxels.
    fn refined(mut self, fine: &Self) -> Self {
        for (point, fine) in self.points.iter_mut().zip(&fine.points) {
            point.1 = 2.0 * fine.1 - point.1;
        }
        self
    }

    /// Returns the stress intensity per load per depth at a crack length [1/√m]. The compliance is a cubic polynomial
    /// through its points.
    pub fn at(&self, length: f64) -> f64 {
        let mut slope = 0.0;
        for (j, &(here, compliance)) in self.points.iter().enumerate() {
            let others = || (0..4).filter(move |&k| k != j);
            for i in others() {
                let rest = others().filter(|&k| k != i).map(|k| self.points[k].0);
                let product: f64 = rest.map(|at| (length - at) / (here - at)).product();
                slope += compliance * product / (here - self.points[i].0);
            }
        }
        (self.factor * slope).sqrt()
    }
}

/// Way in which a plate is pulled apart.
#[derive(Copy, Clone, Debug)]
pub struct Pull {
    /// Load per depth at which the specimen is expected to fail, in plane strain [N/m].
    pub expected: f64,
    /// Load at the start, relative to the expected one.
    pub start: f64,
    /// Growth of the opening of the grips per second, relative to the opening at the expected load [1/s].
    pub rate: f64,
    /// Opening at which to stop, relative to that at the expected load.
    pub most: f64,
    /// Orientation of the plate in the world.
    pub orientation: Rotation,
    /// Angular velocity of the plate and its grips about the third axis [rad/s].
    pub spin: f64,
    /// Whether to stop at the first split.
    pub until_first: bool,
    /// Largest u of a split node at which to stop [m].
    pub reach: f64,
}

impl Pull {
    /// Returns a slow pull that stops at the first split. It starts at 0.65 of the expected load.
    pub fn slow(expected: f64) -> Self {
        Self {
            expected,
            start: 0.65,
            rate: 0.075,
            most: 1.4,
            orientation: Rotation::NONE,
            spin: 0.0,
            until_first: true,
            reach: f64::INFINITY,
        }
    }
}

/// Course of a pull.
#[derive(Clone, Debug, Default)]
pub struct Course {
    /// Load per depth in the tick before the first split [N/m]. NaN if no node was split.
    pub first: f64,
    /// Places u and v of the split nodes [m], in their order.
    pub splits: Vec<[f64; 2]>,
    /// States at ticks with splits.
    pub states: Vec<State>,
    /// Whether the plate came apart.
    pub is_apart: bool,
}

/// State of a plate after a tick.
#[derive(Copy, Clone, Debug)]
pub struct State {
    /// Largest u of all nodes that were split up to the tick [m].
    pub reach: f64,
    /// Work of the grips minus elastic and kinetic energy, per depth [J/m].
    pub dissipated: f64,
}

impl<D: PlateDim> Plate<D> {
    /// Pulls the plate apart.
    pub fn pull(self, pull: &Pull, progress: &Progress) -> Result<Course> {
        let Stretched { moved, stiffness } = self.stretched(progress)?;
        // Opening of the grips at the expected load [m].
        let opening = pull.expected / stiffness;
        let held = self.held();
        let Self { body, frame, .. } = self;
        let middle = D::Vector::from_vec3(frame.middle.as_vec3());
        let turn =
            Rotation::in_plane(-self.setting.turned.to_radians() as f32).then(pull.orientation);
        let mut body = body.rotated_about(turn, middle);
        let spin_axis = Vec3::Z * pull.spin as f32;
        let nodes: Vec<_> = body.mesh().nodes().collect();
        // Places of nodes from the centre of the plate, and their displacements at the expected load, both in axes of the
        // world before it spins.
        let mut starts: BTreeMap<NodeId, [Vec3; 2]> = BTreeMap::new();
        for &(id, node) in &nodes {
            let rest = DVec3::from(node.at.map(f64::from)) * frame.voxel - frame.middle;
            let coordinates = &moved[id.index() * D::N..][..D::N];
            let mut by = DVec3::ZERO;
            for (axis, &u) in coordinates.iter().enumerate() {
                by[axis] = u * opening;
            }
            let pair = [rest, by].map(|vector| turn.apply(vector.as_vec3()));
            starts.insert(id, pair);
            let at = pair[0] + pair[1] * pull.start as f32;
            let velocity = pair[1] * pull.rate as f32 + spin_axis.cross(at);
            let at = middle + D::Vector::from_vec3(at);
            body.set_node_state(id, at, D::Vector::from_vec3(velocity))?;
        }
        for &(id, _) in &held {
            body.fix_node(id);
        }
        let mut world = World::<D>::new(still(D::Vector::ZERO))?;
        let tick = f64::from(world.config().tick);
        let handle = world.add_soft_body(body)?;
        let along = turn.apply(frame.axes[1].as_vec3());
        let ticks = ((pull.most - pull.start) / pull.rate / tick) as u64;
        let mut course = Course {
            first: f64::NAN,
            ..Course::default()
        };
        let mut last = f64::NAN;
        let (mut work, mut reach) = (0.0, f64::NEG_INFINITY);
        let mut start = None;
        for count in 1..=ticks {
            if pull.spin != 0.0 {
                let time = count as f64 * tick;
                let turned = Rotation::in_plane((pull.spin * time) as f32);
                let share = (pull.start + pull.rate * time) as f32;
                let body = world.soft_body_mut(handle)?;
                for (id, _) in &held {
                    let [rest, by] = starts[id];
                    let goal = middle + D::Vector::from_vec3(turned.apply(rest + by * share));
                    let (at, ..) = body.node_state(*id);
                    body.set_node_state(*id, at, (goal - at) / tick as f32)?;
                }
            }
            let report = world.step();
            progress.show_if_slow();
            let body = &world[handle];
            let turned = Rotation::in_plane((pull.spin * count as f64 * tick) as f32);
            let way = turned.apply(along);
            let force = |&(id, sign): &(NodeId, f64)| {
                f64::from(body.force_on(id).to_vec3().dot(way)) * sign
            };
            let load = -0.5 * held.iter().map(force).sum::<f64>() / self.thickness;
            let before = if last.is_nan() { load } else { last };
            work += 0.5 * (before + load) * opening * pull.rate * tick;
            last = load;
            if report.nodes_split > 0 {
                if course.first.is_nan() {
                    course.first = before;
                }
                let back = turned.inverse().then(turn.inverse());
                for event in world.events() {
                    if let Event::NodeSplit { point, .. } = event {
                        let at = back.apply((*point - middle).to_vec3()).as_dvec3();
                        let place = frame.axes.map(|axis| axis.dot(at));
                        reach = place[0].max(reach);
                        course.splits.push(place);
                    }
                }
            }
            if pull.until_first && !course.first.is_nan() {
                break;
            }
            if !pull.until_first && (report.nodes_split > 0 || start.is_none()) {
                let energies = body.energies(D::Vector::ZERO);
                let sum: f64 = energies.iter().map(|one| one.elastic + one.kinetic).sum();
                let dissipated = work - sum / self.thickness;
                let start = *start.get_or_insert(dissipated);
                course.states.push(State {
                    reach,
                    dissipated: dissipated - start,
                });
            }
            course.is_apart |= report.pieces_detached > 0 && load < 0.05 * course.first;
            if course.is_apart || reach >= pull.reach {
                break;
            }
        }
        Ok(course)
    }
}

/// Returns the range of ratios that differ from 1 by at most a bound.
pub fn around_one(bound: f64) -> RangeInclusive<f64> {
    // Rounded, so that the table shows few digits.
    let round = |value: f64| (1e6 * value).round() / 1e6;
    round(1.0 - bound)..=round(1.0 + bound)
}
