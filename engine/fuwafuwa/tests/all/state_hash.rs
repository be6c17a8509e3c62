//! The hash of a world covers every number that a snapshot contains.
//!
//! A serialiser writes the world in the format of snapshots, and records the position of each number, flag,
//! variant, option and list. Then each of these values is changed alone. The changed snapshot must be
//! rejected, or load as a world with another hash.

use crate::blades::Blades;
use crate::vectors::vector;
use fuwafuwa::inspect::Hash;
use fuwafuwa::snapshot::{load, save};
use fuwafuwa::{
    Damping, Dim, Dim2, Dim3, DimVector, Joint, JointAnchor, JointKind, Knife, Layers, Material,
    PronyTerm, RigidBody, Rotation, Shape, SoftBody, StressLaw, Vec3, VoxelGrid, World,
    WorldConfig,
};
use serde::de::value::Error;
use serde::{Serialize, Serializer, ser};
use std::collections::BTreeMap;
use std::ops::Range;

/// Stored values that do not change the hash. Each entry is the end of the value's path, and the reason.
const WITHOUT_EFFECT: [(&str, &str); 2] = [
    (
        "impulse.friction_impulse.3",
        "the fourth component is padding and cleared on loading",
    ),
    (
        "impulse.friction_impulse.2",
        "in 2D the third component is cleared on loading",
    ),
];

/// Names that stand for the items of a tuple or an array in the path of a stored value.
const INDICES: [&str; 9] = ["0", "1", "2", "3", "4", "5", "6", "7", "8"];

/// Stored value of a world: its path, its position in the bytes of the snapshot, and the bytes of a different
/// value.
struct Site {
    path: String,
    place: Range<usize>,
    other: Vec<u8>,
}

/// Serialiser for postcard's format that also records a [`Site`] for each stored value.
#[derive(Default)]
struct Sites {
    bytes: Vec<u8>,
    path: Vec<&'static str>,
    all: Vec<Site>,
}

fn varint(mut number: u64) -> Vec<u8> {
    let mut bytes = Vec::new();
    while number > 0x7f {
        bytes.push(number as u8 | 0x80);
        number >>= 7;
    }
    bytes.push(number as u8);
    bytes
}

fn zigzag(number: i64) -> Vec<u8> {
    varint((number << 1 ^ number >> 63) as u64)
}

impl Sites {
    /// Writes a value and records its [`Site`]. `other` holds the bytes that replace the value in the test.
    fn leaf(&mut self, own: &[u8], other: Vec<u8>) -> Result<(), Error> {
        let first = self.bytes.len();
        self.bytes.extend(own);
        self.note(first, other);
        Ok(())
    }

    /// Records all bytes written since position `first` as one [`Site`]. `other` holds the bytes that replace
    /// them in the test.
    fn note(&mut self, first: usize, other: Vec<u8>) {
        self.all.push(Site {
            path: self.path.join("."),
            place: first..self.bytes.len(),
            other,
        });
    }

    fn variant(&mut self, index: u32) {
        let other = if index == 0 { 1 } else { index - 1 };
        _ = self.leaf(&varint(index.into()), varint(other.into()));
    }

    /// Writes a field, with its name as part of the path.
    fn field<T: Serialize + ?Sized>(&mut self, name: &'static str, value: &T) -> Result<(), Error> {
        self.path.push(name);
        value.serialize(&mut *self)?;
        self.path.pop();
        Ok(())
    }
}

/// Serialiser of a list. In the test, a list is replaced by the same list without its last item.
struct List<'a> {
    sites: &'a mut Sites,
    /// Byte position of the list's length.
    first: usize,
    /// Byte position of the first item.
    items: usize,
    /// Byte position of the last item.
    last: usize,
    /// Number of items.
    length: u64,
}

impl List<'_> {
    fn item<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Error> {
        self.last = self.sites.bytes.len();
        value.serialize(&mut *self.sites)
    }

    fn finish(self) {
        if self.length > 0 {
            let mut other = varint(self.length - 1);
            other.extend(&self.sites.bytes[self.items..self.last]);
            self.sites.note(self.first, other);
        }
    }
}

macro_rules! numbers {
    ($($name:ident($number:ty) $own:ident => $bytes:expr, $other:expr;)*) => {
        $(fn $name(self, $own: $number) -> Result<(), Error> {
            let encode = |$own: $number| -> Vec<u8> { $bytes };
            self.leaf(&encode($own), encode($other))
        })*
    };
}

impl<'a> Serializer for &'a mut Sites {
    type Ok = ();
    type Error = Error;
    type SerializeSeq = List<'a>;
    type SerializeTuple = Tuple<'a>;
    type SerializeTupleStruct = Self;
    type SerializeTupleVariant = Self;
    type SerializeMap = List<'a>;
    type SerializeStruct = Self;
    type SerializeStructVariant = Self;

    numbers! {
        serialize_bool(bool) own => vec![own.into()], !own;
        serialize_i8(i8) own => vec![own as u8], own.wrapping_add(1);
        serialize_i16(i16) own => zigzag(own.into()), own.wrapping_add(1);
        serialize_i32(i32) own => zigzag(own.into()), own.wrapping_add(1);
        serialize_i64(i64) own => zigzag(own), own.wrapping_add(1);
        serialize_u8(u8) own => vec![own], own.wrapping_add(1);
        serialize_u16(u16) own => varint(own.into()), own.wrapping_add(1);
        serialize_u32(u32) own => varint(own.into()), own.wrapping_add(1);
        serialize_u64(u64) own => varint(own), own.wrapping_add(1);
        serialize_f32(f32) own => own.to_le_bytes().to_vec(), next(own);
        serialize_f64(f64) own => own.to_le_bytes().to_vec(), f64::from_bits(own.to_bits() + 1);
    }

    fn serialize_char(self, _: char) -> Result<(), Error> {
        Err(ser::Error::custom("no character is stored"))
    }

    fn serialize_str(self, _: &str) -> Result<(), Error> {
        Err(ser::Error::custom("no text is stored"))
    }

    fn serialize_bytes(self, _: &[u8]) -> Result<(), Error> {
        Err(ser::Error::custom("no byte string is stored"))
    }

    fn serialize_none(self) -> Result<(), Error> {
        self.bytes.push(0);
        Ok(())
    }

    fn serialize_some<T: Serialize + ?Sized>(self, value: &T) -> Result<(), Error> {
        let first = self.bytes.len();
        self.bytes.push(1);
        value.serialize(&mut *self)?;
        self.note(first, vec![0]);
        Ok(())
    }

    fn serialize_unit(self) -> Result<(), Error> {
        Ok(())
    }

    fn serialize_unit_struct(self, _: &'static str) -> Result<(), Error> {
        Ok(())
    }

    fn serialize_unit_variant(
        self,
        _: &'static str,
        index: u32,
        _: &'static str,
    ) -> Result<(), Error> {
        self.variant(index);
        Ok(())
    }

    fn serialize_newtype_struct<T: Serialize + ?Sized>(
        self,
        _: &'static str,
        value: &T,
    ) -> Result<(), Error> {
        value.serialize(self)
    }

    fn serialize_newtype_variant<T: Serialize + ?Sized>(
        self,
        _: &'static str,
        index: u32,
        name: &'static str,
        value: &T,
    ) -> Result<(), Error> {
        self.variant(index);
        self.field(name, value)
    }

    fn serialize_seq(self, length: Option<usize>) -> Result<List<'a>, Error> {
        let length = length.ok_or_else(|| ser::Error::custom("a list has no length"))? as u64;
        let first = self.bytes.len();
        self.bytes.extend(varint(length));
        let items = self.bytes.len();
        Ok(List {
            sites: self,
            first,
            items,
            last: items,
            length,
        })
    }

    fn serialize_tuple(self, _: usize) -> Result<Tuple<'a>, Error> {
        Ok(Tuple {
            sites: self,
            index: 0,
        })
    }

    fn serialize_tuple_struct(self, _: &'static str, _: usize) -> Result<Self, Error> {
        Ok(self)
    }

    fn serialize_tuple_variant(
        self,
        _: &'static str,
        index: u32,
        _: &'static str,
        _: usize,
    ) -> Result<Self, Error> {
        self.variant(index);
        Ok(self)
    }

    fn serialize_map(self, length: Option<usize>) -> Result<List<'a>, Error> {
        self.serialize_seq(length)
    }

    fn serialize_struct(self, _: &'static str, _: usize) -> Result<Self, Error> {
        Ok(self)
    }

    fn serialize_struct_variant(
        self,
        _: &'static str,
        index: u32,
        _: &'static str,
        _: usize,
    ) -> Result<Self, Error> {
        self.variant(index);
        Ok(self)
    }

    fn is_human_readable(&self) -> bool {
        false
    }
}

/// Returns the next representable number away from zero; 1 if the number is not finite.
fn next(number: f32) -> f32 {
    match number.is_finite() {
        true => f32::from_bits(number.to_bits() + 1),
        false => 1.0,
    }
}

impl ser::SerializeSeq for List<'_> {
    type Ok = ();
    type Error = Error;

    fn serialize_element<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Error> {
        self.item(value)
    }

    fn end(self) -> Result<(), Error> {
        self.finish();
        Ok(())
    }
}

impl ser::SerializeMap for List<'_> {
    type Ok = ();
    type Error = Error;

    fn serialize_key<T: Serialize + ?Sized>(&mut self, key: &T) -> Result<(), Error> {
        self.item(key)
    }

    fn serialize_value<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Error> {
        value.serialize(&mut *self.sites)
    }

    fn end(self) -> Result<(), Error> {
        self.finish();
        Ok(())
    }
}

/// Serialiser of a tuple or an array.
struct Tuple<'a> {
    sites: &'a mut Sites,
    index: usize,
}

impl ser::SerializeTuple for Tuple<'_> {
    type Ok = ();
    type Error = Error;

    fn serialize_element<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Error> {
        let name = INDICES[self.index];
        self.index += 1;
        self.sites.field(name, value)
    }

    fn end(self) -> Result<(), Error> {
        Ok(())
    }
}

/// Implements the serialisation of structs with named fields, and of tuple structs and tuple variants with
/// unnamed fields.
macro_rules! fields {
    ($($tuple:ident $element:ident),*; $($structure:ident),*) => {
        $(impl ser::$tuple for &mut Sites {
            type Ok = ();
            type Error = Error;

            fn $element<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Error> {
                value.serialize(&mut **self)
            }

            fn end(self) -> Result<(), Error> {
                Ok(())
            }
        })*
        $(impl ser::$structure for &mut Sites {
            type Ok = ();
            type Error = Error;

            fn serialize_field<T: Serialize + ?Sized>(
                &mut self,
                name: &'static str,
                value: &T,
            ) -> Result<(), Error> {
                self.field(name, value)
            }

            fn end(self) -> Result<(), Error> {
                Ok(())
            }
        })*
    };
}

fields! {
    SerializeTupleStruct serialize_field,
    SerializeTupleVariant serialize_field;
    SerializeStruct, SerializeStructVariant
}

/// Returns a snapshot with the version and dimensions of `header`, the bytes of `state`, and a valid
/// checksum.
fn with_state(header: &[u8], state: &[u8]) -> Vec<u8> {
    let mut changed = header[..9].to_vec();
    changed.extend(Hash::of(state).to_le_bytes());
    changed.extend(state);
    changed
}

/// Returns whether a world stores a value with a path that ends in `end`. The items of an empty list are not
/// stored.
fn stores<D: Dim>(world: &World<D>, end: &str) -> bool {
    let mut sites = Sites::default();
    world.serialize(&mut sites).unwrap();
    sites.all.iter().any(|site| site.path.ends_with(end))
}

/// Changes each stored value of a world alone, and checks that the hash changes or loading fails. Adds the
/// number of changes of each path to `counts`.
fn check_all_values<D: Dim>(world: &World<D>, counts: &mut BTreeMap<String, u32>) {
    let mut sites = Sites::default();
    world.serialize(&mut sites).unwrap();
    let bytes = save(world);
    let (header, state) = bytes.split_at(17);
    assert!(
        sites.bytes == state,
        "the sites must be those of a snapshot"
    );
    let hash = world.hash();
    assert_eq!(load::<D>(&bytes).unwrap().hash(), hash);
    let mut missed = BTreeMap::<String, u32>::new();
    for Site { path, place, other } in sites.all {
        let (before, after) = (&state[..place.start], &state[place.end..]);
        let changed = with_state(header, &[before, &other, after].concat());
        if load::<D>(&changed).is_ok_and(|changed| changed.hash() == hash) {
            *missed.entry(path.clone()).or_default() += 1;
        }
        *counts.entry(path).or_default() += 1;
    }
    let allowed = &WITHOUT_EFFECT[..if D::N == 2 { 2 } else { 1 }];
    missed.retain(|path, _| !allowed.iter().any(|(end, _)| path.ends_with(end)));
    assert!(missed.is_empty(), "not in the hash: {missed:#?}");
}

/// Returns a world that uses all parts of the state: soft and rigid bodies of all kinds, joints, a knife, a
/// sensor, a tearing and a plastic body, a sleeping body, a fixed node, layers and free slots.
fn world_of_everything<D: Blades>(n: usize) -> World<D> {
    let mut world = World::<D>::new(WorldConfig::default()).unwrap();
    let depth = if D::N == 3 { 0.2 } else { 0.0 };
    let floor = Shape::half_space(D::Vector::Y, D::Vector::ZERO);
    world
        .add_rigid_body(RigidBody::fixed(floor).with_friction(0.4))
        .unwrap();
    let soft = |n: usize, at: D::Vector, material: Material| {
        let body = SoftBody::new(VoxelGrid::cube(n, 0.4).unwrap(), &[material]).unwrap();
        body.translated(at)
    };
    let rubber = Material {
        stress_law: StressLaw::Yeoh {
            second: 0.1,
            third: 0.01,
        },
        ..Material::default()
    };
    let plastic = Material {
        yield_strain: 0.02,
        prony: [PronyTerm::new(0.5, 0.2), PronyTerm::NONE],
        strength: 300.0,
        // Calms the cube after its fall, so that no crack grows before rigid bodies press on each other.
        damping: Damping {
            mass: 10.0,
            ..Damping::default()
        },
        toughness: 30.0,
        ..Material::default()
    };
    let cube = world
        .add_soft_body(soft(n, vector(0.0, 0.02, 0.0), plastic))
        .unwrap();
    let resting = world
        .add_soft_body(soft(1, vector(3.0, 0.0, 0.0), Material::default()))
        .unwrap();
    let lying = world
        .add_soft_body(soft(1, vector(0.1, 0.45, 0.0), Material::default()))
        .unwrap();
    let gone = world
        .add_soft_body(soft(1, vector(9.0, 0.0, 0.0), rubber))
        .unwrap();
    let ghost = Layers {
        memberships: 1,
        filters: 3,
    };
    world.set_layers(resting, ghost).unwrap();
    // A coupled hand tears the cube.
    let hand = RigidBody::coupled(Shape::ball(0.08)).at(vector(-0.2, 0.3, depth));
    let hand = world.add_rigid_body(hand).unwrap();
    let holder = RigidBody::kinematic(Shape::ball(0.05)).at(vector(0.5, 0.1, depth));
    let holder = holder.with_sensor(true);
    let holder = world.add_rigid_body(holder).unwrap();
    let edge = [-0.3, 0.3].map(|z| vector(0.0, 0.0, z));
    let knife = Knife::new(holder, edge, vector(-1.0, 0.0, 0.0));
    world.add_knife(knife).unwrap();
    let gate = Shape::capsule(vector(0.0, 0.2, depth), vector(0.4, 0.2, depth), 0.1);
    let gate = RigidBody::fixed(gate).with_friction(0.5).with_sensor(true);
    world.add_rigid_body(gate).unwrap();
    let cuboid = |x, y| Shape::cuboid(D::Vector::splat(0.1)).translated(vector(x, y, depth));
    let boxes = [(2.0, 0.1), (2.0, 0.31), (2.0, 0.8), (2.4, 0.8)].map(|(x, y)| {
        let free = RigidBody::dynamic(cuboid(x, y), 0.5);
        world
            .add_rigid_body(free.rotated(Rotation::in_plane(0.02)))
            .unwrap()
    });
    let on = |k: usize, x| JointAnchor::on(boxes[k], vector(x, 0.8, depth));
    let spring = JointKind::Spring {
        stiffness: 50.0,
        damping: 0.5,
        length: 0.3,
    };
    let corner = JointAnchor::on(resting, vector(3.0, 0.4, 0.0)).within(0.1);
    let ceiling = JointAnchor::Point(vector(2.0, 1.2, depth));
    let joints = [
        (on(2, 2.2), on(3, 2.2), JointKind::Pin),
        (on(2, 2.0), ceiling, spring),
        (on(3, 2.4), corner, JointKind::Rope { length: 0.7 }),
    ];
    for (first, second, tie) in joints {
        let joint = Joint::new([first, second], tie).with_breaking_force(1e3);
        world.add_joint(joint).unwrap();
    }
    world.remove(gone).unwrap();
    let body = world.soft_body_mut(lying).unwrap();
    let (node, _) = body.mesh().nodes().next().unwrap();
    body.fix_node(node);
    for tick in 0..60 {
        let at = vector(-0.2 + 0.03 * tick as f32, 0.3, depth);
        world.set_target_position(hand, at).unwrap();
        let at = vector(0.5 - 0.012 * tick as f32, 0.1, depth);
        world.set_target_position(holder, at).unwrap();
        if tick == 11 {
            let corner = Vec3::new(0.3, -1.0, -0.5);
            let blade = D::blade(corner, Vec3::Y * 2.0, Vec3::Z);
            assert!(world.cut(cube, &blade).unwrap() > 0);
        }
        world.step();
        // Returns in the first tick with a node in its cooldown after a split. Only a growing crack starts a
        // cooldown; a cut does not.
        if tick > 11 && stores(&world, "state.cooldowns.points") {
            return world;
        }
    }
    panic!("no crack grows");
}

/// Ends of paths of stored values that the world must contain, so that the test covers them.
const COVERED: [&str; 15] = [
    "joints.slots.item.attached.1.Position",
    "joints.slots.item.kind.stiffness",
    "knives.slots.item.samples.passed",
    "nearby.rigids.list.impulse.normal_impulse",
    "nearby.nodes.list.impulse.friction_impulse",
    "nearby.pairs.list.met_in_front",
    "rigids.slots.item.reactions.contact",
    "bodies.slots.item.state.damage",
    "bodies.slots.item.state.cooldowns.points",
    "bodies.slots.item.state.tip_deviations.at",
    "bodies.slots.item.state.batches.internal_states",
    "bodies.slots.item.topology.mesh.free_nodes",
    "events.ContactForce.point",
    "touching",
    "inside",
];

fn check_everything<D: Blades>(n: usize) {
    let mut world = world_of_everything::<D>(n);
    let mut counts = BTreeMap::new();
    check_all_values(&world, &mut counts);
    let is_torn = |body: &SoftBody<D>| body.pieces().count() > 1;
    assert!(world.soft_bodies().any(|(_, body)| is_torn(body)));
    // Removes the hand and checks all values again later, when bodies sleep.
    let hand = world.nth_target_follower(0).unwrap();
    world.remove(hand).unwrap();
    for _ in 0..300 {
        world.step();
    }
    let mut bodies = world.soft_bodies();
    assert!(bodies.any(|(_, body)| body.pieces().list.iter().any(|piece| piece.asleep)));
    assert!(world.rigid_bodies().any(|(_, body)| body.is_asleep()));
    check_all_values(&world, &mut counts);
    for part in COVERED {
        assert!(counts.keys().any(|path| path.starts_with(part)), "{part}");
    }
    println!("{} changes", counts.values().sum::<u32>());
}

#[test]
fn every_stored_value_changes_the_hash_2d() {
    check_everything::<Dim2>(5);
}

#[test]
fn every_stored_value_changes_the_hash_3d() {
    check_everything::<Dim3>(3);
}
