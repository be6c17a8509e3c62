//! The organ to be operated on: its voxels, their materials, and their position in the patient.

use fuwafuwa::inspect::Elasticity;
use fuwafuwa::{
    DEFAULT_TICK, Damping, Dim3, Material, NodeId, RigidBody, Shape, SoftBody, SoftBodyHandle,
    Vec3, VoxelGrid, World, WorldConfig,
};
use fuwafuwa_scan::Organ;

/// Weight of an organ in saline, as a fraction of its weight in air. A brain of 1400 g weighs some 50 g in
/// its fluid.
const AFLOAT: f32 = 0.04;
/// Drag of the saline: relative loss of the organ's speed per second [1/s].
const DRAG: f32 = 2.0;
/// Height of the lower part of the organ, which is fixed in a mould, as a fraction of the organ's height.
const HELD: f32 = 0.25;
/// Number of voxels along the longest side above which an organ counts as fine.
const FINE: usize = 40;
/// Number of substeps per tick for coarse and for fine organs. Fine organs would take too long with more.
const SUBSTEPS: [u32; 2] = [16, 8];
/// Maximum length of a case name [characters].
const MOST_LETTERS: usize = 200;
/// Maximum number of materials: a voxel stores the numbers 1 to 255.
const MOST_MATERIALS: usize = 255;

/// Organ to be operated on.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// Name of the case.
    pub name: String,
    /// Voxels: x towards the patient's right, y towards the head, z towards the back.
    pub grid: VoxelGrid<Dim3>,
    /// Materials of the voxels, starting at number 1.
    pub tissues: Vec<Material>,
    /// Names of the materials, starting at number 1. Materials without a name are shown by their number.
    pub names: Vec<String>,
    /// Position of the grid's low corner in the patient, RAS+ [mm].
    pub corner: [f64; 3],
}

/// Reason why a case cannot be operated on.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CaseError {
    /// The engine rejects the grid, a material or the organ.
    #[error("{0}")]
    Engine(#[from] fuwafuwa::Error),
    /// A field is out of range.
    #[error("{field}: expected {expected}, found {found}")]
    Field {
        /// Name of the field.
        field: &'static str,
        /// Expected value.
        expected: &'static str,
        /// Given value.
        found: String,
    },
}

/// An organ on its table.
pub struct Table {
    /// World of the organ.
    pub world: World<Dim3>,
    /// Handle of the organ.
    pub organ: SoftBodyHandle,
    /// Region in which tools can move: low and high corner [m].
    pub room: [Vec3; 2],
    /// Initial position of the low corner of the organ's grid [m].
    pub corner: Vec3,
    /// Mass scaling factor of the tissue, at least 1. Heavier tissue is stable with fewer substeps. Stiffness
    /// and weight are unchanged; only motion is slower.
    pub inertia: f32,
}

impl Case {
    /// Creates the case of an organ from scans.
    pub fn of(name: &str, organ: &Organ) -> Self {
        let corner = organ.patient_at([0.0; 3]);
        let most = organ.grid.voxels().map(|at| organ.grid.material(at)).max();
        Self {
            name: name.chars().take(MOST_LETTERS).collect(),
            tissues: tissues(usize::from(most.unwrap_or(1))),
            names: Vec::new(),
            grid: organ.grid.clone(),
            corner,
        }
    }

    /// Checks the case, which may come from an untrusted file.
    ///
    /// # Errors
    /// [`CaseError`] names the invalid field.
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
        if self.names.len() > MOST_MATERIALS {
            let expected = "names of at most 255 materials";
            return Err(field("names", expected, self.names.len().to_string()));
        }
        let letters = self.names.iter().map(|name| name.chars().count()).max();
        if let Some(letters) = letters.filter(|letters| *letters > MOST_LETTERS) {
            let expected = "at most 200 letters";
            return Err(field("names", expected, letters.to_string()));
        }
        if !self.corner.iter().all(|k| k.abs() <= 1e7) {
            let expected = "a point within 10 km of the patient's origin";
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
            let expected = "a longest side of 1 mm to 2 m";
            return Err(field("grid", expected, format!("{long} m")));
        }
        Ok(())
    }

    /// Lays the organ on a table.
    ///
    /// # Errors
    /// [`CaseError`] if the case is invalid.
    pub fn place_on_table(&self) -> Result<Table, CaseError> {
        self.check()?;
        let voxel = self.grid.voxel_size();
        let size = Vec3::from(self.grid.size().map(|extent| extent as f32 * voxel));
        let longest = size.max_element();
        let substeps = SUBSTEPS[usize::from(longest / voxel > FINE as f32 + 0.5)];
        let (body, inertia) = self.body(substeps)?;
        let [low, _] = bounds(&body);
        // Puts the lowest point of the organ at the height of the table.
        let corner = Vec3::new(-0.5 * size.x, -low.y, -0.5 * size.z);
        let mut body = body.translated(corner);
        hold_below(&mut body);
        let mut world = World::new(WorldConfig {
            gravity: Vec3::new(0.0, -9.81 * AFLOAT / inertia, 0.0),
            drag: DRAG,
            max_substeps: substeps,
            ..WorldConfig::default()
        })?;
        let top = Shape::half_space(Vec3::Y, Vec3::ZERO);
        world.add_rigid_body(RigidBody::fixed(top).with_friction(0.6))?;
        let organ = world.add_soft_body(body)?;
        let (around, above) = (0.35 * longest, 0.6 * longest);
        let room = [
            Vec3::new(corner.x - around, 0.0, corner.z - around),
            Vec3::new(
                -corner.x + around,
                size.y - low.y + above,
                -corner.z + around,
            ),
        ];
        Ok(Table {
            world,
            organ,
            room,
            corner,
            inertia,
        })
    }

    /// Returns the organ as a body that is stable with the given number of substeps, and its mass scaling
    /// factor.
    fn body(&self, substeps: u32) -> Result<(SoftBody<Dim3>, f32), CaseError> {
        let wanted = f64::from(DEFAULT_TICK) / f64::from(substeps);
        let ratio = wanted / self.longest_substep()?;
        // With k times the mass, waves are √k times as slow and substeps may be √k times as long. The mass
        // therefore grows with the square of `ratio`. The factor 1.001 allows for rounding.
        let inertia = (1.001 * ratio * ratio).max(1.0) as f32;
        let heavier = |tissue: &Material| Material {
            density: tissue.density * inertia,
            ..*tissue
        };
        let heavy: Vec<Material> = self.tissues.iter().map(heavier).collect();
        let body = SoftBody::new(self.grid.clone(), &heavy)?;
        Ok((body, inertia))
    }

    /// Returns the longest substep that is stable for all materials of the organ [s]. It is measured on a row
    /// with one voxel of each material.
    fn longest_substep(&self) -> Result<f64, CaseError> {
        let mut is_used = [false; 256];
        for at in self.grid.voxels() {
            is_used[usize::from(self.grid.material(at))] = true;
        }
        let used = (1..=u8::MAX).filter(|&number| is_used[usize::from(number)]);
        let used: Vec<u8> = used.collect();
        let row =
            VoxelGrid::<Dim3>::from_materials([used.len(), 1, 1], self.grid.voxel_size(), used);
        let row = row?;
        let row = SoftBody::new(row, &self.tissues)?;
        Ok(row.longest_substep())
    }

    /// Returns the name of a material by its number, starting at 1.
    pub fn material_name(&self, number: u8) -> String {
        let name = usize::from(number)
            .checked_sub(1)
            .and_then(|at| self.names.get(at));
        name.cloned()
            .unwrap_or_else(|| format!("material {number}"))
    }

    /// Returns the volume of a voxel [ml].
    pub fn millilitres(&self) -> f64 {
        let edge = 100.0 * f64::from(self.grid.voxel_size());
        edge * edge * edge
    }

    /// Converts a point in the grid, relative to its low corner [m], to the patient's RAS+ coordinates [mm].
    pub fn patient_at(&self, place: Vec3) -> [f64; 3] {
        let [right, front, up] = self.corner;
        let [x, y, z] = (1000.0 * place.as_dvec3()).to_array();
        [right + x, front - z, up + y]
    }
}

/// Returns `count` default materials for an organ. Four kinds repeat.
///
/// The stiffness of brain in slow tests is 1 to 2 kPa; other soft organs are somewhat stiffer. The cut
/// energies are rough values, chosen so that a sharp edge cuts before the organ yields by more than a
/// centimetre. The toughness K follows from the cut energy: K² (1 − ν²) / Y.
pub fn tissues(count: usize) -> Vec<Material> {
    // Young's modulus [Pa] and cut energy per area [J/m²].
    const KINDS: [(f64, f64); 4] = [
        (2000.0, 8.0),
        (3000.0, 12.0),
        (6000.0, 25.0),
        (4000.0, 80.0),
    ];
    let kinds = KINDS.iter().cycle().take(count.clamp(1, MOST_MATERIALS));
    let poisson = 0.4;
    let tissue = |&(young, energy): &(f64, f64)| Material {
        elasticity: Elasticity { young, poisson },
        density: 1050.0,
        damping: Damping::at(0.3, 8.0),
        friction: 0.1,
        strength: 30_000.0,
        toughness: (young * energy / (1.0 - poisson * poisson)).sqrt() as f32,
        ..Material::default()
    };
    kinds.map(tissue).collect()
}

/// Returns the low and high corner of the bounding box of a body's nodes [m].
pub(crate) fn bounds(body: &SoftBody<Dim3>) -> [Vec3; 2] {
    let positions = body.mesh().nodes().map(|(id, _)| body.node_state(id).0);
    positions.fold([Vec3::MAX, Vec3::MIN], |[low, high], at| {
        [low.min(at), high.max(at)]
    })
}

/// Fixes the nodes that lie in the mould.
fn hold_below(body: &mut SoftBody<Dim3>) {
    let [low, high] = bounds(body);
    let top = low.y + HELD * (high.y - low.y);
    let nodes = body.mesh().nodes().map(|(id, _)| id);
    let below = nodes.filter(|&id| body.node_state(id).0.y <= top);
    let below: Vec<NodeId> = below.collect();
    below.into_iter().for_each(|id| body.fix_node(id));
}
