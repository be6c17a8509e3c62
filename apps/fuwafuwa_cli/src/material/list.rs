//! Materials of the library as tables.

use crate::report;
use anyhow::{Context, Result};
use fuwafuwa::library::{self, LibraryMaterial, LibraryValue, MATERIALS, Quantity};
use fuwafuwa::{Material, StressLaw};
use fuwafuwa_scenes::scene::MaterialText;
use std::process::ExitCode;

/// List the materials of the library.
#[derive(Debug, clap::Args)]
pub struct List {}

/// Show a material of the library: each number with its source, what takes the place of missing numbers, and the material
/// for scenes.
#[derive(Debug, clap::Args)]
pub struct Show {
    /// Name of the material, see `fuwafuwa material list`.
    name: String,
}

/// Prints the names of all materials with their moduli.
pub fn list() -> Result<ExitCode> {
    let head = ["name", "shear modulus [Pa]", "law", "about"];
    let mut rows = vec![head.map(String::from).to_vec()];
    rows.extend(MATERIALS.iter().map(|record| {
        let material = record.material();
        vec![
            record.name.into(),
            format!("{:.0}", material.elasticity.shear_modulus()),
            law(&material).into(),
            record.about.into(),
        ]
    }));
    output::print(&report::table(&rows, &[false, true, false, false]))?;
    Ok(ExitCode::SUCCESS)
}

/// Prints one material.
pub fn show(arguments: &Show) -> Result<ExitCode> {
    let name = &arguments.name;
    let record = library::find(name).with_context(|| {
        let similar = library::similar_names(name).join(", ");
        format!("expected a material of the library ({similar}), found {name:?}")
    })?;
    output::print(&text(record)?)?;
    Ok(ExitCode::SUCCESS)
}

fn law(material: &Material) -> &'static str {
    match material.stress_law {
        StressLaw::Corotational => "corotational",
        StressLaw::NeoHookean => "neo-Hookean",
        StressLaw::Yeoh { .. } => "Yeoh",
    }
}

/// Returns the description of a material.
fn text(record: &LibraryMaterial) -> Result<String> {
    let head = ["quantity", "value", "spread", "°C", "1/s", "source"];
    let mut rows = vec![head.map(String::from).to_vec()];
    rows.extend(record.values.iter().map(row));
    let table = report::table(&rows, &[false, true, true, true, true, false]);
    let missing = Quantity::ALL
        .into_iter()
        .filter(|&quantity| record.is_missing(quantity));
    let missing: Vec<&str> = missing.map(Quantity::key).collect();
    let missing = match missing.is_empty() {
        true => "nothing".into(),
        false => missing.join(", "),
    };
    let used = record.material();
    let notes: String = { notes(record, &used).into_iter() }
        .map(|note| format!("{note}\n"))
        .collect();
    Ok(format!(
        "{}: {}\n\n{table}\nNot in the library: {missing}.\nThe simulation uses: density {} kg/m³, Poisson's ratio {}, law {}, \
         strength {} Pa, fracture energy {} J/m². Other properties: defaults of Material, without damping.\n{notes}\n\
         # For scenes; the same as like = {:?}.\n{}",
        record.name,
        record.about,
        used.density,
        used.elasticity.poisson,
        law(&used),
        limit(used.strength),
        limit(used.fracture_energy()),
        record.name,
        MaterialText::table_of(&used)?,
    ))
}

/// Returns what to know before use: strains of the fit, break under tension, and whether the material can tear.
fn notes(record: &LibraryMaterial, used: &Material) -> Vec<String> {
    let digits = report::digits;
    let mut notes = Vec::new();
    let fitted = record.fitted_strain();
    if let Some([low, high]) = fitted {
        let [shortest, longest] = [1.0 + low, 1.0 + high].map(digits);
        notes.push(format!(
            "The law was fitted at stretches of {shortest} to {longest}; beyond them it is extrapolated."
        ));
    } else if record.value(Quantity::ShearModulus).is_some()
        || record.value(Quantity::Young).is_some()
    {
        notes
            .push("The law was not fitted to a curve: the modulus holds for small strains.".into());
    }
    if let Some(state) = record.tensile_break() {
        let published = record.value(Quantity::StrainAtBreak);
        let published = published.map_or(String::new(), |value| {
            format!(" (published: {})", digits(value.value[0]))
        });
        let strain = state.stretch - 1.0;
        let is_beyond = fitted.is_none_or(|[_, high]| strain > high);
        notes.push(format!(
            "A bar reaches the published nominal strength at a strain of {}{published}, with the true stress that the \
             simulation uses{}.",
            digits(strain),
            match is_beyond {
                true => "; the strain is extrapolated",
                false => "",
            },
        ));
    }
    let cannot = match (used.strength.is_finite(), used.toughness.is_finite()) {
        (true, true) => return notes,
        (false, false) => "without strength and fracture energy, it cannot tear",
        (false, true) => "without a strength, no crack starts: only cuts and given cracks grow",
        (true, false) => "without a fracture energy, cracks do not grow",
    };
    notes.push(format!("The simulated material: {cannot}."));
    notes
}

/// Formats a number that is infinite if the material does not tear.
fn limit(number: f32) -> String {
    match number.is_finite() {
        true => report::digits(f64::from(number)),
        false => "infinite".into(),
    }
}

fn row(value: &LibraryValue) -> Vec<String> {
    let unit = value.quantity.unit();
    let numbers = match value.quantity {
        Quantity::Yeoh | Quantity::RateToughening => {
            format!("{}, {}", value.value[0], value.value[1])
        }
        _ => value.value[0].to_string(),
    };
    let option = |number: Option<f64>| number.map_or(String::new(), |number| number.to_string());
    vec![
        match unit.is_empty() {
            true => value.quantity.key().into(),
            false => format!("{} [{unit}]", value.quantity.key()),
        },
        numbers,
        value
            .spread
            .map_or(String::new(), |[low, high]| format!("{low} to {high}")),
        option(value.temperature),
        option(value.rate),
        value.source.into(),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text_of(name: &str) -> String {
        text(library::find(name).unwrap()).unwrap()
    }

    #[test]
    fn description_names_sources_and_missing_numbers() {
        let gelatine = text_of("gelatine-10");
        for part in [
            "Forte and others 2015",
            "Not in the library: density, poisson, yeoh, strength",
            "strength infinite Pa, fracture energy 1.1 J/m²",
            "without a strength, no crack starts",
            "the modulus holds for small strains",
        ] {
            assert!(gelatine.contains(part), "{gelatine}");
        }
        assert!(!gelatine.contains("cannot tear"), "{gelatine}");
        assert!(text_of("liver").contains("without a strength, no crack starts"));
        assert!(text_of("tofu-firm").contains("it cannot tear"));
        assert!(text_of("ecoflex-00-30").contains("without a fracture energy, cracks do not grow"));
        assert!(!text_of("polyurethane").contains("The simulated material"));
    }

    #[test]
    fn description_names_strains_of_the_fit_and_of_the_break() {
        let dragon_skin = text_of("dragon-skin-10");
        for part in [
            "fitted at stretches of 1.06 to 3.99; beyond them it is extrapolated",
            "at a strain of 14.62 (published: 10)",
            "the strain is extrapolated",
        ] {
            assert!(dragon_skin.contains(part), "{dragon_skin}");
        }
    }

    #[test]
    fn description_has_the_material_for_scenes() {
        for record in MATERIALS {
            let text = text(record).unwrap();
            let (_, table) = text.split_once("\n[[material]]\n").unwrap();
            let scene =
                format!("dim = 3\n[[material]]\n{table}\n[[body]]\nshape = \"ball\"\nn = 4\n");
            let scene = fuwafuwa_scenes::Scene::read("a.toml", &scene, &[]).unwrap();
            assert_eq!(scene.materials(), [record.material()], "{table}");
        }
    }

    #[test]
    fn unknown_material_is_answered_with_similar_names() {
        let name = "rubber".into();
        let error = show(&Show { name }).unwrap_err().to_string();
        let expected = "expected a material of the library (natural-rubber), found \"rubber\"";
        assert_eq!(error, expected);
    }
}
