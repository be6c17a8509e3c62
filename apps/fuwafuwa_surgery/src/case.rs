//! What is operated on: the voxels of an organ, what they are made of, and where in the patient they lay.

use fuwafuwa::world::TICK;
use fuwafuwa::{
    BodyError, BuildError, Dim3, Elasticity, Material, NodeId, Refused, RigidBody, Shape, SoftBody,
    SoftBodyHandle, VoxelGrid, World, WorldConfig,
};
use fuwafuwa_scan::Organ;

/// An organ lies in saline: of its weight so much is left. A brain of 1400 g weighs some 50 g in its fluid.
const AFLOAT: f32 = 0.04;
/// Share of its speed that everything loses to the saline in a second [1/s].
const DRAG: f32 = 2.0;
/// Of its height so much lies in a mould that holds it.
const HELD: f32 = 0.25;
/// Up to so many voxels along its longest side an organ has the first number of substeps, beyond the second: what is fine
/// would take too long otherwise.
const FINE: usize = 40;
const SUBSTEPS: [u32; 2] = [16, 8];
/// Most letters of the name of a case.
const MOST_LETTERS: usize = 200;
/// Most materials of one: those that [`tissues`] knows start over.
const MOST_MATERIALS: usize = 255;

/// What is operated on.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// What it is called.
    pub name: String,
    /// Its voxels, x to the patient's right, y up to the head, z to the back.
    pub grid: VoxelGrid<Dim3>,
    /// What they are made of, material number 1 first.
    pub tissues: Vec<Material>,
    /// Where in the patient the low corner of the grid lies, RAS+ [mm].
    pub corner: [f64; 3],
}

/// Why a case cannot be operated on.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CaseError {
    /// The voxels are none.
    #[error("{0}")]
    Grid(BuildError),
    /// The materials are none.
    #[error("{0}")]
    Body(BodyError),
    /// The world does not take it.
    #[error("{0}")]
    World(Refused),
    /// A field is out of range.
    #[error("{field}: expected {expected}, found {found}")]
    Field {
        /// Which.
        field: &'static str,
        /// What was expected.
        expected: &'static str,
        /// What was found.
        found: String,
    },
}

impl From<Refused> for CaseError {
    fn from(refused: Refused) -> Self {
        Self::World(refused)
    }
}

/// An organ on its table.
pub struct Table {
    /// The world that it lies in.
    pub world: World<Dim3>,
    /// The organ.
    pub organ: SoftBodyHandle,
    /// Where tools may be: the low and the high corner [m].
    pub room: [[f32; 3]; 2],
    /// Where the low corner of the organ's grid is [m], before anything moves.
    pub corner: [f32; 3],
    /// By what factor tissue moves as if it were heavier, so that few substeps do. It is as stiff as it should be, and at
    /// rest it weighs as much.
    pub inertia: f32,
}

impl Case {
    /// That of an organ from scans.
    pub fn of(name: &str, organ: &Organ) -> Self {
        let corner = organ.patient_at([0.0; 3]);
        let most = organ.grid.voxels().map(|at| organ.grid.material(at)).max();
        Self {
            name: name.chars().take(MOST_LETTERS).collect(),
            tissues: tissues(usize::from(most.unwrap_or(1))),
            grid: organ.grid.clone(),
            corner,
        }
    }

    /// Whether it may be operated on, whoever wrote it.
    ///
    /// # Errors
    /// [`CaseError`] names what is wrong.
    pub fn check(&self) -> Result<(), CaseError> {
        let field = |field, expected, found: String| CaseError::Field {
            field,
            expected,
            found,
        };
        let letters = self.name.chars().count();
        if letters > MOST_LETTERS {
            let expected = "at most 200 letters";
            return Err(field("name", expected, letters.to_string()));
        }
        if self.tissues.len() > MOST_MATERIALS {
            let expected = "at most 255 materials";
            return Err(field("tissues", expected, self.tissues.len().to_string()));
        }
        if !self.corner.iter().all(|k| k.abs() <= 1e7) {
            let expected = "a place within ten kilometres of the patient's origin";
            return Err(field("corner", expected, format!("{:?}", self.corner)));
        }
        let grid = &self.grid;
        let size = grid
            .size()
            .map(|extent| usize::try_from(extent).unwrap_or(0));
        let longest = size.into_iter().max().unwrap_or(0);
        if longest > *fuwafuwa_scan::RESOLUTIONS.end() {
            let expected = "at most 256 voxels along each side";
            return Err(field("grid", expected, longest.to_string()));
        }
        let long = longest as f32 * grid.voxel_size();
        if !(1e-3..=2.0).contains(&long) {
            let expected = "an organ of a millimetre to two metres";
            return Err(field("grid", expected, format!("{long} m")));
        }
        Ok(())
    }

    /// Lays it on a table.
    ///
    /// # Errors
    /// [`CaseError`] says why that cannot be.
    pub fn lay(&self) -> Result<Table, CaseError> {
        self.check()?;
        let voxel = self.grid.voxel_size();
        let size = self.grid.size().map(|extent| extent as f32 * voxel);
        let longest = size.into_iter().fold(0.0, f32::max);
        let substeps = SUBSTEPS[usize::from(longest / voxel > FINE as f32 + 0.5)];
        let (body, inertia) = self.body(substeps)?;
        let corner = [-0.5 * size[0], 0.0, -0.5 * size[2]];
        let [low, _] = bounds(&body);
        // The lowest of it is at the height of the table.
        let mut body = body.translated([corner[0], -low[1], corner[2]]);
        hold_below(&mut body);
        let mut world = World::new(WorldConfig {
            gravity: [0.0, -9.81 * AFLOAT / inertia, 0.0],
            drag: DRAG,
            most_substeps: substeps,
            ..WorldConfig::default()
        })?;
        let top = Shape::half_space([0.0, 1.0, 0.0], [0.0; 3]);
        world.add_rigid_body(RigidBody::fixed(top, 0.6))?;
        let organ = world.add_soft_body(body);
        let (around, above) = (0.35 * longest, 0.6 * longest);
        let room = [
            [corner[0] - around, 0.0, corner[2] - around],
            [
                -corner[0] + around,
                size[1] - low[1] + above,
                -corner[2] + around,
            ],
        ];
        Ok(Table {
            world,
            organ,
            room,
            corner: [corner[0], -low[1], corner[2]],
            inertia,
        })
    }

    /// The organ as a body that so many substeps are enough for, and by how much heavier it moves for that.
    fn body(&self, substeps: u32) -> Result<(SoftBody<Dim3>, f32), CaseError> {
        let wanted = f64::from(TICK) / f64::from(substeps);
        let ratio = wanted / self.longest_substep()?;
        // Of what is k times as heavy a wave is √k times as slow. A thousandth more, against rounding.
        let inertia = (1.001 * ratio * ratio).max(1.0) as f32;
        let heavier = |tissue: &Material| Material {
            density: tissue.density * inertia,
            ..*tissue
        };
        let heavy: Vec<Material> = self.tissues.iter().map(heavier).collect();
        let body = SoftBody::new(self.grid.clone(), &heavy).map_err(CaseError::Body)?;
        Ok((body, inertia))
    }

    /// The longest substep that its stiffest material bears [s]: that of a row of one voxel of each.
    fn longest_substep(&self) -> Result<f64, CaseError> {
        let mut is_used = [false; 256];
        for at in self.grid.voxels() {
            is_used[usize::from(self.grid.material(at))] = true;
        }
        let used = (1..=u8::MAX).filter(|&number| is_used[usize::from(number)]);
        let used: Vec<u8> = used.collect();
        let row =
            VoxelGrid::<Dim3>::from_materials([used.len(), 1, 1], self.grid.voxel_size(), used);
        let row = row.map_err(CaseError::Grid)?;
        let row = SoftBody::new(row, &self.tissues).map_err(CaseError::Body)?;
        Ok(row.longest_substep())
    }

    /// The volume of a voxel [ml].
    pub fn millilitres(&self) -> f64 {
        let edge = 100.0 * f64::from(self.grid.voxel_size());
        edge * edge * edge
    }

    /// The place in the patient, RAS+ [mm], of a place in the grid, from its low corner [m].
    pub fn patient_at(&self, place: [f32; 3]) -> [f64; 3] {
        let [right, front, up] = self.corner;
        let [x, y, z] = place.map(|k| 1000.0 * f64::from(k));
        [right + x, front - z, up + y]
    }
}

/// What the materials of an organ are made of, until somebody says more: they get firmer with their number, and start over.
///
/// Brain bears 1 to 2 kPa in a slow test, and other soft organs some more. The energies of cuts are rough numbers, chosen so
/// that a sharp edge cuts before the organ gives way by more than a centimetre. A toughness is the root of such an energy
/// times Young's modulus.
pub fn tissues(count: usize) -> Vec<Material> {
    // Young's modulus [Pa], and the energy of an area that is cut [J/m²].
    const KINDS: [(f64, f32); 4] = [
        (2000.0, 8.0),
        (3000.0, 12.0),
        (6000.0, 25.0),
        (4000.0, 80.0),
    ];
    let kinds = KINDS.iter().cycle().take(count.clamp(1, MOST_MATERIALS));
    let tissue = |&(young, energy): &(f64, f32)| Material {
        elasticity: Elasticity {
            young,
            poisson: 0.4,
        },
        density: 1050.0,
        damping: 0.3,
        friction: 0.1,
        strength: 30_000.0,
        toughness: (young as f32 * energy).sqrt(),
        ..Material::default()
    };
    kinds.map(tissue).collect()
}

/// The least and the greatest coordinates of a body's nodes [m].
pub(crate) fn bounds(body: &SoftBody<Dim3>) -> [[f32; 3]; 2] {
    let mut bounds = [[f32::MAX; 3], [f32::MIN; 3]];
    for (id, _) in body.mesh().nodes() {
        let (at, ..) = body.node_state(id);
        for axis in 0..3 {
            bounds[0][axis] = bounds[0][axis].min(at[axis]);
            bounds[1][axis] = bounds[1][axis].max(at[axis]);
        }
    }
    bounds
}

/// Holds what lies in the mould.
fn hold_below(body: &mut SoftBody<Dim3>) {
    let [low, high] = bounds(body);
    let top = low[1] + HELD * (high[1] - low[1]);
    let nodes = body.mesh().nodes().map(|(id, _)| id);
    let below = nodes.filter(|&id| body.node_state(id).0[1] <= top);
    let below: Vec<NodeId> = below.collect();
    below.into_iter().for_each(|id| body.fix_node(id));
}
