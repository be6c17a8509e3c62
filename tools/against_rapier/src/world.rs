//! Rapier's worlds, in 2D and in 3D. They are two crates with the same names in them, hence the macro.

use std::f32::consts::PI;

use cpu_time::ThreadTime;

use crate::Drop;

/// How a cell resists.
#[derive(Clone, Copy, Debug)]
pub enum Law {
    /// Linear elasticity in the frame that turns with the cell.
    Corotational,
    /// Springs along the edges of the cells, and a constraint on each cell's volume.
    Springs {
        /// Natural frequency of a spring between two nodes that have nothing else [Hz].
        frequency: f32,
    },
}

impl Law {
    /// The springs that make a block of tetrahedra as stiff as the scene wants it.
    ///
    /// Each voxel of edge h has three axial springs and three on face diagonals, all with the same constant k. Under a
    /// strain along one axis an axial spring stores ½kh² of energy and two diagonals half as much each, so C11 = 2k/h;
    /// likewise C12 = k/2h. Hence E = C11 − 2·C12²/(C11 + C12) = 1.8 k/h, and Poisson's ratio is C12/(C11 + C12) = 0.2.
    /// Two nodes of mass m = ρh³ swing on one spring at (2πf)² = 2k/m.
    pub fn springs(scene: &Drop, voxel_size: f32) -> Self {
        let stiffness = scene.young * voxel_size / 1.8;
        let mass = scene.density * voxel_size.powi(3);
        Self::Springs {
            frequency: (2.0 * stiffness / mass).sqrt() / (2.0 * PI),
        }
    }
}

/// How much Rapier works on a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Substeps of the solver, to which Rapier adds up to 4 while a body hits fast. More make a body stiffer.
    pub substeps: usize,
    /// How often it goes over its constraints in each of them. More make a body stiffer, too.
    pub sweeps: usize,
}

impl Default for Effort {
    /// Rapier's own.
    fn default() -> Self {
        Self {
            substeps: 4,
            sweeps: 4,
        }
    }
}

/// How far up and down a body reaches.
#[derive(Clone, Copy, Debug)]
pub struct Span {
    /// Height of the lowest node [m].
    pub lowest: f32,
    /// Height of the highest node [m].
    pub highest: f32,
    /// Whether all nodes are at finite places; if not, the heights mean nothing.
    pub finite: bool,
}

impl Span {
    /// Over nodes at these heights [m].
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

    /// From the lowest to the highest node [m].
    pub fn height(&self) -> f32 {
        self.highest - self.lowest
    }
}

/// A world in which something falls.
pub trait Falling {
    /// Its name and version, and what its bodies are made of.
    fn engine(&self) -> String;

    /// One frame.
    fn step(&mut self);

    /// How far up and down everything soft reaches.
    fn span(&self) -> Span;

    /// Substeps in a frame.
    fn substeps(&self) -> usize;

    /// Factor by which the engine itself lowered Young's modulus.
    fn stiffness_scale(&self) -> f64 {
        1.0
    }

    /// How many pieces there are.
    fn pieces(&self) -> usize;

    /// Share of the pieces that sleep.
    fn asleep(&self) -> f64;

    /// One frame, and the time that the processor worked on it [ms]. By the clock on the wall a long frame of the one
    /// engine would suffer more from whatever else the machine does than a short one of the other.
    fn timed_step(&mut self) -> f64 {
        let start = ThreadTime::now();
        self.step();
        start.elapsed().as_secs_f64() * 1e3
    }
}

/// Width of the contact skin, in voxels.
const SKIN: f32 = 0.1;

macro_rules! world {
    ($rapier:ident, $corners:literal, $vector:expr, $cells:literal) => {
        use crate::Drop;
        use crate::mesh::Simplices;
        use crate::world::{Effort, Falling, Law, SKIN, Span};
        use $rapier::na::Unit;
        use $rapier::prelude::*;

        /// A soft body above a half-space.
        pub struct World {
            /// Rapier's own world.
            pub rapier: PhysicsWorld,
            effort: Effort,
        }

        impl World {
            /// The body of `mesh`, at rest, as high above the floor as the scene wants it.
            pub fn new(mesh: &Simplices<$corners>, scene: &Drop, effort: Effort, law: Law) -> Self {
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
            law: Law,
        ) -> SoftBodyBuilder {
            let skin = SKIN * mesh.voxel_size;
            let up = Vector::Y * (scene.height + skin);
            let vector = $vector;
            let (cell_model, softness) = match law {
                Law::Corotational => (SoftBodyCellModel::Corotational, None),
                Law::Springs { frequency } => {
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
            // Rapier puts the body's own surface in place of the ball.
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
    //! Rapier's plane.
    world!(
        rapier2d,
        3,
        |[x, y, _]: [f32; 3]| Vector::new(x, y),
        "corotational triangles"
    );
}

pub mod space {
    //! Rapier's space.
    world!(
        rapier3d,
        4,
        |[x, y, z]: [f32; 3]| Vector::new(x, y, z),
        "tetrahedra with springs"
    );
}
