//! Materials of the library as tables.

use crate::report;
use anyhow::{Context, Result};
use fuwafuwa::library::{self, LibraryMaterial, LibraryValue, MATERIALS, Quantity};
use fuwafuwa::{Material, StressLaw};
use std::process::ExitCode;

/// List the materials of the library.
#[derive(Debug, clap::Args)]
pub struct List {}

/// Show a material of the library: each number with its source, and what takes the place of missing numbers.
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
        format!("no material {name:?}: `fuwafuwa material list` shows the names")
    })?;
    output::print(&text(record))?;
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
fn text(record: &LibraryMaterial) -> String {
    let head = ["quantity", "value", "spread", "°C", "1/s", "source"];
    let mut rows = vec![head.map(String::from).to_vec()];
    rows.extend(record.values.iter().map(row));
    let table = report::table(&rows, &[false, true, true, true, true, false]);
    let missing = Quantity::ALL
        .into_iter()
        .filter(|&quantity| record.is_missing(quantity));
    let missing: Vec<&str> = missing.map(Quantity::key).collect();
    let used = record.material();
    format!(
        "{}: {}\n\n{table}\nNot published: {}.\nThe simulation uses: density {} kg/m³, Poisson's ratio {}, law {}, strength {} Pa, \
         fracture energy {} J/m².\n",
        record.name,
        record.about,
        if missing.is_empty() {
            "nothing".into()
        } else {
            missing.join(", ")
        },
        used.density,
        used.elasticity.poisson,
        law(&used),
        limit(used.strength),
        limit(used.fracture_energy()),
    )
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

    #[test]
    fn description_names_sources_and_missing_numbers() {
        let gelatine = text(library::find("gelatine-10").unwrap());
        assert!(gelatine.contains("Forte and others 2015"), "{gelatine}");
        assert!(
            gelatine.contains("Not published: density, poisson, yeoh, strength"),
            "{gelatine}"
        );
        assert!(
            gelatine.contains("strength infinite Pa, fracture energy 1.1 J/m²"),
            "{gelatine}"
        );
    }
}
