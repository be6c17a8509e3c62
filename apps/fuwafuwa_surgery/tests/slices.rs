//! Slices show the inside of the organ at the correct position, with the patient's left on the left, and show
//! cuts.

#[path = "../../../engine/fuwafuwa_scan/tests/phantom/mod.rs"]
mod phantom;

use fuwafuwa::{Blade, Dim3, SoftBody, Vec2, Vec3};
use fuwafuwa_scan::{Scan, Segmentation};
use fuwafuwa_surgery::case::{Case, Table};
use fuwafuwa_surgery::phantom::{GROWTH, HALF, case};
use fuwafuwa_surgery::slices::{Cut, Slice};

fn table() -> (Case, Table) {
    let case = case(40).unwrap();
    let table = case.place_on_table().unwrap();
    (case, table)
}

/// Returns the world position [m] of a point in the patient, RAS+ [mm].
fn place(case: &Case, table: &Table, [right, front, up]: [f64; 3]) -> Vec3 {
    let own = [
        right - case.corner[0],
        up - case.corner[2],
        case.corner[1] - front,
    ];
    table.corner + Vec3::from(own.map(|k| (k / 1000.0) as f32))
}

fn organ(table: &Table) -> &SoftBody<Dim3> {
    &table.world[table.organ]
}

#[test]
fn growth_appears_at_its_anatomical_position() {
    let (case, table) = table();
    let (growth, _) = GROWTH;
    let at = place(&case, &table, growth);
    for cut in Cut::ALL {
        let slice = Slice::of(organ(&table), cut, at[cut.axis()]);
        let page = cut.on_page(at);
        assert_eq!(slice.material_at(page), Some(3), "{cut:?}");
        let whole = cut.on_page(place(&case, &table, [0.0; 3]));
        // The growth lies in the patient's right half, in front and above. Axial and coronal slices show it
        // right of the middle; the sagittal slice, seen from the left, shows it left of the middle, where the
        // front is.
        let beside = page.x - whole.x;
        let above = page.y - whole.y;
        match cut {
            Cut::Axial | Cut::Coronal => assert!(beside > 0.015 && above > 0.008, "{cut:?}"),
            Cut::Sagittal => assert!(beside < -0.015 && above > 0.008),
        }
        // The slice must show no growth at the mirrored position.
        let other = Vec2::new(whole.x - beside, page.y);
        assert_ne!(slice.material_at(other), Some(3), "{cut:?}");
        assert_eq!(slice.material_at(page + Vec2::X), None);
    }
}

#[test]
fn slice_area_matches_the_deformed_organ() {
    let (case, mut table) = table();
    let at = place(&case, &table, [0.0, 0.0, -8.0]);
    let [right, front, up] = HALF;
    // Area of the ellipse in which a plane 8 mm below the centre cuts the ellipsoid [m²]. The bend of the kidney
    // keeps this area, and the plane passes below the ureter.
    let share = 1.0 - (8.0 / up).powi(2);
    let ellipse = (1e-6 * std::f64::consts::PI * right * front * share) as f32;
    let area = Slice::of(organ(&table), Cut::Axial, at.y).area();
    assert!((area / ellipse - 1.0).abs() < 0.03, "{area} {ellipse}");
    // Stretches the organ by a tenth along x, to check that slices show the deformed shape.
    let body = table.world.soft_body_mut(table.organ).unwrap();
    let nodes: Vec<_> = body.mesh().nodes().map(|(id, _)| id).collect();
    for id in nodes {
        let (at, ..) = body.node_state(id);
        let stretched = at.with_x(1.1 * at.x);
        body.set_node_state(id, stretched, Vec3::ZERO).unwrap();
    }
    let slice = Slice::of(organ(&table), Cut::Axial, at.y);
    assert!((slice.area() / (1.1 * area) - 1.0).abs() < 1e-3);
    let strains = slice.patches.iter().map(|patch| patch.strain);
    assert!(
        strains.clone().all(|strain| (strain - 0.1).abs() < 0.02),
        "{:?}",
        strains.fold(0.0, f32::max)
    );
}

#[test]
fn closed_cut_is_visible() {
    let (case, mut table) = table();
    let at = place(&case, &table, [10.0, 0.0, 0.0]);
    assert!(Slice::of(organ(&table), Cut::Axial, at.y).cracks.is_empty());
    let corner = at + Vec3::new(0.0003, -0.01, -0.02);
    let blade = Blade::parallelogram(corner, 0.1 * Vec3::Y, 0.04 * Vec3::Z);
    table.world.cut(table.organ, &blade).unwrap();
    let slice = Slice::of(organ(&table), Cut::Axial, at.y);
    assert!(slice.cracks.len() > 20, "{}", slice.cracks.len());
    let voxel = case.grid.voxel_size();
    for end in slice.cracks.as_flattened() {
        assert!((end.x - at.x).abs() < 1.5 * voxel, "{end:?}");
        assert!((end.y + at.z).abs() < 0.02 + 1.5 * voxel, "{end:?}");
    }
    // The slice of the cut organ must have the same area as that of the uncut one.
    let whole = Slice::of(
        &SoftBody::new(case.grid.clone(), &case.tissues).unwrap(),
        Cut::Axial,
        at.y - table.corner.y,
    );
    assert!((slice.area() / whole.area() - 1.0).abs() < 1e-3);
    // A slice beside the cut must show no cracks.
    assert!(
        Slice::of(organ(&table), Cut::Sagittal, at.x - 0.02)
            .cracks
            .is_empty()
    );
}

/// Scan with 2 mm voxels, with the first axis towards the patient's *left*. A ball of label 2 lies in the
/// right half of a ball of label 1.
fn scan() -> Scan {
    let axes = [[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let away = |patient: [f64; 3], middle: [f64; 3]| {
        let squares = [0, 1, 2].map(|k: usize| (patient[k] - middle[k]).powi(2));
        squares.iter().sum::<f64>().sqrt()
    };
    let file = phantom::File::of(axes, [2.0; 3], |patient| {
        match (
            away(patient, [0.0; 3]) < 28.0,
            away(patient, [14.0, 0.0, 0.0]) < 8.0,
        ) {
            (_, true) => 2.0,
            (true, false) => 1.0,
            (false, false) => 0.0,
        }
    });
    file.scan()
}

#[test]
fn scan_with_left_axis_shows_right_on_the_right() {
    let labels = Segmentation::labels(&[(1, 1), (2, 2)]);
    let organ = phantom::organ(&scan(), &labels, 32);
    let case = Case::of("marked", &organ);
    let table = case.place_on_table().unwrap();
    let body = &table.world[table.organ];
    let [mark, mirrored] = [14.0, -14.0].map(|right| place(&case, &table, [right, 0.0, 0.0]));
    for cut in [Cut::Axial, Cut::Coronal] {
        let slice = Slice::of(body, cut, mark[cut.axis()]);
        assert_eq!(slice.material_at(cut.on_page(mark)), Some(2), "{cut:?}");
        assert_eq!(slice.material_at(cut.on_page(mirrored)), Some(1), "{cut:?}");
        assert!(cut.on_page(mark).x > cut.on_page(mirrored).x);
        assert_eq!(cut.letters()[1], "R");
    }
    let right = case.patient_at(mark - table.corner);
    assert!((right[0] - 14.0).abs() < 1e-3, "{right:?}");
}
