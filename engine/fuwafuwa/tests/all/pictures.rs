//! Meshes as text pictures, which show how elements are graded and remodelled.
//!
//! In the input, `#` is a voxel. In the output, a digit is the level of the element that contains the voxel.
//! A letter instead of a digit (`b` for level 1, `c` for level 2) marks an element that has lost children, so
//! that it no longer fills its cell.

use fuwafuwa::Dim;
use fuwafuwa::inspect::Element;
use fuwafuwa::{Blade, Dim2, Material, SoftBody, Vec2, VoxelGrid};

fn body_of(picture: &[&str]) -> SoftBody<Dim2> {
    let size = [picture[0].len(), picture.len(), 1];
    let grid = VoxelGrid::from_fn(size, 1.0, |[x, y, _]| {
        let row = picture[picture.len() - 1 - y as usize].as_bytes();
        u8::from(row[x as usize] == b'#')
    });
    SoftBody::new(grid.unwrap(), &[Material::default()]).unwrap()
}

fn sign(element: &Element) -> char {
    let whole = element.children == Dim2::ALL_CORNERS || element.cell.level == 0;
    let first = if whole { b'0' } else { b'a' };
    char::from(first + element.cell.level)
}

fn picture_of(body: &SoftBody<Dim2>) -> Vec<String> {
    let [width, height, _] = body.grid().size();
    let voxel = |x, y| {
        let owner = body.mesh().owner([x, y, 0]);
        owner.map_or('.', |id| sign(body.mesh().element(id).unwrap()))
    };
    let rows = (0..height).rev();
    rows.map(|y| (0..width).map(|x| voxel(x, y)).collect())
        .collect()
}

/// Grades the voxels, cuts along the segments in order, and compares the graded and the remodelled mesh with
/// the expected text pictures.
fn check(voxels: &[&str], graded: &[&str], cuts: &[([f32; 2], [f32; 2])], remodelled: &[&str]) {
    let mut body = body_of(voxels);
    let found = picture_of(&body);
    assert_eq!(found, graded, "graded:\n{}", found.join("\n"));
    for &(from, to) in cuts {
        body.cut(&Blade::segment(Vec2::from(from), Vec2::from(to)));
        body.mesh()
            .validate(body.grid(), body.connectivity())
            .unwrap();
    }
    let found = picture_of(&body);
    assert_eq!(found, remodelled, "remodelled:\n{}", found.join("\n"));
}

#[test]
fn remodelling_refines_around_half_cut_square() {
    check(
        &["################"; 16],
        &[
            "0000000000000000",
            "0bbbbbbbbbbbbbb0",
            "0bccccccccccccb0",
            "0bccccccccccccb0",
            "0bcc22222222ccb0",
            "0bcc22222222ccb0",
            "0bcc22222222ccb0",
            "0bcc22222222ccb0",
            "0bcc22222222ccb0",
            "0bcc22222222ccb0",
            "0bcc22222222ccb0",
            "0bcc22222222ccb0",
            "0bccccccccccccb0",
            "0bccccccccccccb0",
            "0bbbbbbbbbbbbbb0",
            "0000000000000000",
        ],
        &[([8.0, 17.0], [8.0, 8.0])],
        &[
            "0000000000000000",
            "0bbbbbb00bbbbbb0",
            "0bccccb00bccccb0",
            "0bccccb00bccccb0",
            "0bccccb00bccccb0",
            "0bccccb00bccccb0",
            "0bccccb00bccccb0",
            "0bccccb00bccccb0",
            "0bccccb00bccccb0",
            "0bccccbbbbccccb0",
            "0bccccccccccccb0",
            "0bccccccccccccb0",
            "0bccccccccccccb0",
            "0bccccccccccccb0",
            "0bbbbbbbbbbbbbb0",
            "0000000000000000",
        ],
    );
}

#[test]
fn remodelling_refines_around_cut_through_bar() {
    check(
        &["########################"; 6],
        &[
            "000000000000000000000000",
            "0bbbbbbbbbbbbbbbbbbbbbb0",
            "0bccccccccccccccccccccb0",
            "0bccccccccccccccccccccb0",
            "0bbbbbbbbbbbbbbbbbbbbbb0",
            "000000000000000000000000",
        ],
        &[([12.0, -1.0], [12.0, 7.0])],
        &[
            "000000000000000000000000",
            "0bbbbbbbbbb00bbbbbbbbbb0",
            "0bccccccccb00bccccccccb0",
            "0bccccccccb00bccccccccb0",
            "0bbbbbbbbbb00bbbbbbbbbb0",
            "000000000000000000000000",
        ],
    );
}

#[test]
fn remodelling_refines_around_nicked_corner() {
    check(
        &["############"; 12],
        &[
            "000000000000",
            "0bbbbbbbbbb0",
            "0bccccccccb0",
            "0bccccccccb0",
            "0bcc2222ccb0",
            "0bcc2222ccb0",
            "0bcc2222ccb0",
            "0bcc2222ccb0",
            "0bccccccccb0",
            "0bccccccccb0",
            "0bbbbbbbbbb0",
            "000000000000",
        ],
        &[([3.0, -1.0], [3.0, 3.0]), ([3.0, 3.0], [-1.0, 3.0])],
        &[
            "000000000000",
            "0bbbbbbbbbb0",
            "0bccccccccb0",
            "0bccccccccb0",
            "0bccccccccb0",
            "0bccccccccb0",
            "0b1111ccccb0",
            "0b1111ccccb0",
            "000011ccccb0",
            "000011ccccb0",
            "0b00bbbbbbb0",
            "000000000000",
        ],
    );
}
