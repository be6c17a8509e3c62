//! Common interface of both engines' worlds, and Rapier's worlds in 2D and 3D. A macro builds Rapier's
//! worlds, because `rapier2d` and `rapier3d` are two crates with equal names.

use std::f32::consts::PI;

use cpu_time::ThreadTime;

use crate::Drop;

/// Constitutive model of a cell.
#[derive(Clone, Copy, Debug)]
pub enum CellModel {
    /// Linear elasticity in the corotated frame of the cell; uses Young's modulus and Poisson's ratio of the
    /// scene.
    Corotational,
    /// Springs along the edges of the cells, and a volume constraint per cell.
    Springs {
        /// Natural frequency of a spring between two otherwise free nodes [Hz].
        frequency: f32,
    },
}

impl CellModel {
    /// Returns springs that make a block of tetrahedra as stiff as the scene requires.
    ///
    /// Each voxel of edge h has three axial springs and three on face diagonals, all with the same constant
    /// k. Under a uniaxial strain an axial spring stores ½kh² of energy and two diagonals half as much each,
    /// so C11 = 2k/h; likewise C12 = k/2h. Hence E = C11 − 2·C12²/(C11 + C12) = 1.8 k/h, and Poisson's ratio
    /// is C12/(C11 + C12) = 0.2. Two nodes of mass m = ρh³ on one spring oscillate at (2πf)² = 2k/m.
    pub fn springs(scene: &Drop, voxel_size: f32) -> Self {
        let stiffness = scene.young * voxel_size / 1.8;
        let mass = scene.density * voxel_size.powi(3);
        Self::Springs {
            frequency: (2.0 * stiffness / mass).sqrt() / (2.0 * PI),
        }
    }
}

/// Solver effort of Rapier per frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Substeps of the solver. Rapier adds up to 4 during fast impacts. More substeps make a body stiffer.
    pub substeps: usize,
    /// Iterations over the constraints per substep. More iterations make a body stiffer, too.
    pub sweeps: usize,
}

impl Default for Effort {
    /// Rapier's defaults.
    fn default() -> Self {
        Self {
            substeps: 4,
            sweeps: 4,
        }
    }
}

/// Vertical extent of a body.
#[derive(Clone, Copy, Debug)]
pub struct Span {
    /// Height of the lowest node [m].
    pub lowest: f32,
    /// Height of the highest node [m].
    pub highest: f32,
    /// Whether all node positions are finite; otherwise the heights are meaningless.
    pub finite: bool,
}

impl Span {
    /// Returns the extent of nodes at these heights [m].
    pub fn of(heights: impl Iterator<Item = f32>) -> Self {
        let nothing = Self {
            lowest: f32::INFINITY,
            highest: f32::NEG_INFINITY,
            finite: true,
        };
        heights.fold(nothing, |span, height| Self {
            lowest: span.lowest.min(height),
            highest: span.highest.max(height),
            finite: span.finite && height.is_finite(),
        })
    }

    /// Distance from the lowest to the highest node [m].
    pub fn height(&self) -> f32 {
        self.highest - self.lowest
    }
}

/// World with falling soft bodies, in one of the engines.
pub trait Falling {
    /// Name and version of the engine, and the elements of its bodies.
    fn engine(&self) -> String;

    /// Runs a frame.
    fn step(&mut self);

    /// Vertical extent of all soft bodies.
    fn span(&self) -> Span;

    /// Substeps per frame.
    fn substeps(&self) -> usize;

    /// Factor by which the engine lowered Young's modulus; 1 if it did not.
    fn stiffness_scale(&self) -> f64 {
        1.0
    }

    /// Number of pieces.
    fn pieces(&self) -> usize;

    /// Fraction of the pieces that sleep.
    fn asleep(&self) -> f64;

    /// Runs a frame and returns its processor time [ms]. Wall-clock time would include other load on the
    /// machine, which penalises the slower engine more.
    fn timed_step(&mut self) -> f64 {
        let start = ThreadTime::now();
        self.step();
        start.elapsed().as_secs_f64() * 1e3
    }
}

/// Thickness of the contact skin [voxels].
const SKIN: f32 = 0.1;

macro_rules! world {
    ($rapier:ident, $corners:literal, $vector:expr, $cells:literal) => {
        use crate::Drop;
        use crate::mesh::Simplices;
        use crate::world::{CellModel, Effort, Falling, SKIN, Span};
        use $rapier::na::Unit;
        use $rapier::prelude::*;

        /// Soft body above a half-space.
        pub struct World {
            /// World of Rapier.
            pub rapier: PhysicsWorld,
            effort: Effort,
        }

        impl World {
            /// Builds a world with the body of `mesh` at rest, at the initial height of the scene.
            pub fn new(
                mesh: &Simplices<$corners>,
                scene: &Drop,
                effort: Effort,
                law: CellModel,
            ) -> Self {
                let mut rapier = PhysicsWorld::new();
                rapier.gravity = Vector::Y * -scene.gravity;
                rapier.integration_parameters.dt = crate::FRAME;
                rapier.integration_parameters.num_solver_iterations = effort.substeps;
                let floor = ColliderBuilder::halfspace(Unit::new_unchecked(Vector::Y));
                rapier.insert(RigidBodyBuilder::fixed(), floor.friction(scene.friction));
                rapier.insert_soft_body(body(mesh, scene, effort, law));
                Self { rapier, effort }
            }
        }

        fn body(
            mesh: &Simplices<$corners>,
            scene: &Drop,
            effort: Effort,
            law: CellModel,
        ) -> SoftBodyBuilder {
            let skin = SKIN * mesh.voxel_size;
            let up = Vector::Y * (scene.height + skin);
            let vector = $vector;
            let (cell_model, softness) = match law {
                CellModel::Corotational => (SoftBodyCellModel::Corotational, None),
                CellModel::Springs { frequency } => {
                    let undamped = SpringCoefficients::new(frequency, 0.0);
                    (SoftBodyCellModel::Volume, Some(undamped))
                }
            };
            let material = SoftBodyMaterial {
                young_modulus: scene.young,
                poisson_ratio: scene.poisson,
                elastic_damping_ratio: 0.0,
                ..softness.map_or_else(SoftBodyMaterial::default, SoftBodyMaterial::uniform)
            };
            // Takes friction and skin from a ball collider. Rapier replaces the ball's shape by the surface
            // of the body.
            let surface = ColliderBuilder::ball(skin).friction(scene.friction);
            SoftBodyBuilder::new(mesh.positions.iter().map(|&at| vector(at) + up).collect())
                .masses(
                    mesh.volumes
                        .iter()
                        .map(|volume| volume * scene.density)
                        .collect(),
                )
                .cells(mesh.cells.clone())
                .cell_model(cell_model)
                .material(material)
                .particle_radius(skin)
                .surface_collider(surface)
                .additional_pgs_iterations(effort.sweeps - 1)
                .can_sleep(scene.sleeps)
        }

        impl Falling for World {
            fn engine(&self) -> String {
                let sweeps = self.effort.sweeps;
                format!("Rapier {}, {}, {sweeps} sweeps", $rapier::VERSION, $cells)
            }

            fn step(&mut self) {
                self.rapier.step();
            }

            fn span(&self) -> Span {
                let bodies = self.rapier.soft_bodies();
                Span::of(bodies.flat_map(|(_, body)| body.particle_positions().map(|at| at.y)))
            }

            fn substeps(&self) -> usize {
                self.effort.substeps
            }

            fn pieces(&self) -> usize {
                self.rapier.soft_bodies.len()
            }

            fn asleep(&self) -> f64 {
                let bodies = self.rapier.soft_bodies();
                let asleep = bodies.filter(|(_, body)| body.is_sleeping()).count();
                asleep as f64 / self.pieces() as f64
            }
        }
    };
}

pub mod plane {
    //! Rapier in 2D.
    world!(
        rapier2d,
        3,
        |[x, y, _]: [f32; 3]| Vector::new(x, y),
        "corotational triangles"
    );
}

pub mod space {
    //! Rapier in 3D.
    world!(
        rapier3d,
        4,
        |[x, y, z]: [f32; 3]| Vector::new(x, y, z),
        "tetrahedra with springs"
    );
}
