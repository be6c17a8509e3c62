//! Mesh of a body, updated in place.

use crate::colours::SoftColours;
use crate::dimension::Dimension;
use crate::pose::Pose;
use crate::surface::{Surface, Vertex};
use bevy_asset::{Assets, Handle, RenderAssetUsages};
use bevy_ecs::component::Component;
use bevy_math::Vec3;
use bevy_mesh::{Indices, Mesh, MeshVertexAttribute, PrimitiveTopology, VertexAttributeValues};
use fuwafuwa::SoftBody;

/// Mesh of a body and the surface from which it is written.
#[derive(Component)]
pub struct BodyMesh<D: Dimension> {
    mesh: Handle<Mesh>,
    colours: SoftColours,
    surface: D::Surface,
    /// Pose at the last write of the mesh if the whole body slept then; otherwise `None`.
    asleep_at: Option<Pose>,
}

/// Returns a mesh without triangles.
pub fn empty_mesh() -> Mesh {
    let mut mesh = Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::all());
    mesh.insert_attribute(Mesh::ATTRIBUTE_POSITION, Vec::<[f32; 3]>::new());
    mesh.insert_attribute(Mesh::ATTRIBUTE_NORMAL, Vec::<[f32; 3]>::new());
    mesh.insert_attribute(Mesh::ATTRIBUTE_COLOR, Vec::<[f32; 4]>::new());
    mesh.insert_indices(Indices::U32(Vec::new()));
    mesh
}

impl<D: Dimension> BodyMesh<D> {
    pub fn new(mesh: Handle<Mesh>, colours: SoftColours) -> Self {
        Self {
            mesh,
            colours,
            surface: D::Surface::default(),
            asleep_at: None,
        }
    }

    pub fn mesh(&self) -> Handle<Mesh> {
        self.mesh.clone()
    }

    /// Writes the mesh of a body relative to a pose. Does nothing if the body sleeps and the pose is
    /// unchanged.
    pub fn follow(&mut self, body: &SoftBody<D>, pose: &Pose, meshes: &mut Assets<Mesh>) {
        let is_asleep = body.pieces().list.iter().all(|piece| piece.asleep);
        if is_asleep && self.asleep_at == Some(*pose) {
            return;
        }
        self.asleep_at = is_asleep.then_some(*pose);
        let Some(mut mesh) = meshes.get_mut(&self.mesh) else {
            // Nothing is written if the mesh asset was removed.
            return;
        };
        let is_new = self.surface.follow(body, &self.colours);
        self.write_places(&mut mesh, pose);
        if is_new {
            self.write_triangles(&mut mesh);
        }
    }

    fn write_places(&self, mesh: &mut Mesh, pose: &Pose) {
        // Unused vertices are placed at the origin, inside the body, so that they do not enlarge the bounding
        // box.
        let local =
            |vertex: Option<Vertex>| vertex.map_or(Vec3::ZERO, |own| pose.local(own.position));
        let back = pose.rotation.inverse();
        let normal = |vertex: Option<Vertex>| vertex.map_or(Vec3::Z, |own| back * own.normal);
        let places = self.surface.vertices().map(|own| local(own).into());
        overwrite(mesh, Mesh::ATTRIBUTE_POSITION, places);
        let normals = self.surface.vertices().map(|own| normal(own).into());
        overwrite(mesh, Mesh::ATTRIBUTE_NORMAL, normals);
    }

    fn write_triangles(&self, mesh: &mut Mesh) {
        let colours = self.surface.colours(&self.colours);
        if let Ok(VertexAttributeValues::Float32x4(known)) =
            mesh.try_attribute_mut(Mesh::ATTRIBUTE_COLOR)
        {
            refill(known, colours);
        }
        if let Ok(Indices::U32(known)) = mesh.try_indices_mut() {
            refill(known, self.surface.indices());
        }
    }
}

fn overwrite(
    mesh: &mut Mesh,
    attribute: MeshVertexAttribute,
    values: impl Iterator<Item = [f32; 3]>,
) {
    if let Ok(VertexAttributeValues::Float32x3(known)) = mesh.try_attribute_mut(attribute) {
        refill(known, values);
    }
}

/// Replaces the contents of a vector and reuses its memory.
fn refill<T>(known: &mut Vec<T>, values: impl Iterator<Item = T>) {
    known.clear();
    known.extend(values);
}
