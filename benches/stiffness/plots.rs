//! Plots step responses, and the commanded and the apparent stiffness, as SVG.

use crate::cases::{Case, Friction};
use crate::closed_loop::{Held, Senses};
use crate::statics::Pushed;
use crate::{fits, motion, statics};
use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};
use plotters::prelude::*;
use std::error::Error;
use std::path::Path;
use sun2xp::model::configuration::{Law, Scheme};

const RATE: f64 = 1000.0;
const POSES: usize = 6;
const FONT: &str = "sans-serif";

/// Draws `step-response.svg`, with one panel per controller, and `stiffness-ellipses.svg`, with one panel per
/// controller and pose, in `folder`. All fingers run at 1000 Hz.
pub fn draw(folder: &Path, schemes: &[Scheme], seed: u64) -> Result<(), Box<dyn Error>> {
    std::fs::create_dir_all(folder)?;
    let cases: Vec<Case> = schemes
        .iter()
        .map(|&scheme| Case { scheme, rate: RATE, poses: POSES, seed, law: Law::Exact, numbers: None })
        .collect();
    step_responses(&folder.join("step-response.svg"), &cases)?;
    ellipses(&folder.join("stiffness-ellipses.svg"), &cases)
}

fn step_responses(file: &Path, cases: &[Case]) -> Result<(), Box<dyn Error>> {
    const WATCHED: f64 = 0.6;
    let area = SVGBackend::new(file, (520 * cases.len() as u32, 360)).into_drawing_area();
    area.fill(&WHITE)?;
    for (panel, case) in area.split_evenly((1, cases.len())).iter().zip(cases) {
        let mut chart = ChartBuilder::on(panel)
            .caption(format!("5 mm step, Kx 3 N/cm, {}, {POSES} poses", case.name()), (FONT, 16))
            .margin(8)
            .x_label_area_size(34)
            .y_label_area_size(44)
            .build_cartesian_2d(0.0..WATCHED, -0.2..1.6)?;
        chart.configure_mesh().x_desc("s").y_desc("part of the step").draw()?;
        let limit = |part: f64| LineSeries::new([(0.0, part), (WATCHED, part)], BLACK.mix(0.5).stroke_width(1));
        chart.draw_series(limit(0.95))?;
        chart.draw_series(limit(1.05))?;
        for (number, response) in motion::step_responses(case, 3.0, WATCHED).into_iter().enumerate() {
            chart.draw_series(LineSeries::new(response, Palette99::pick(number).stroke_width(1)))?;
        }
    }
    area.present()?;
    Ok(())
}

/// Draws the forces for a deflection of 1 mm in every direction of a coordinate plane: those of Kx = diag(1, 5, 2) in
/// black, and those of the apparent stiffness, measured with friction, in red. Only the components of the forces in the
/// plane are drawn. There is one row per controller and one column per pose.
fn ellipses(file: &Path, cases: &[Case]) -> Result<(), Box<dyn Error>> {
    const PLANE: [usize; 2] = [0, 1];
    let kx = Matrix3::from_diagonal(&Vector3::new(1.0, 5.0, 2.0));
    let area = SVGBackend::new(file, (180 * POSES as u32, 210 * cases.len() as u32)).into_drawing_area();
    area.fill(&WHITE)?;
    let panels = area.split_evenly((cases.len(), POSES));
    let subjects = cases.iter().flat_map(|case| case.poses().into_iter().map(move |pose| (case, pose)));
    for (panel, (case, pose)) in panels.iter().zip(subjects) {
        let finger = &case.finger(&pose, Friction::Default);
        let held = Held { case, finger, belief: finger, pose: &pose, kx: &kx, senses: Senses::Counts };
        let Pushed { forces, deflections, .. } = statics::pushed_along_axes(&held);
        let found = fits::apparent_stiffness(&forces, &deflections);
        let degrees = pose.map(f64::to_degrees);
        let caption = format!("{} ({:.0}, {:.0}, {:.0})", case.controller(), degrees[0], degrees[1], degrees[2]);
        let mut chart = ChartBuilder::on(panel)
            .caption(caption, (FONT, 11))
            .margin(6)
            .x_label_area_size(28)
            .y_label_area_size(34)
            .build_cartesian_2d(-0.6..0.6, -0.6..0.6)?;
        chart.configure_mesh().x_labels(3).y_labels(3).disable_mesh().x_desc("f_x, N").y_desc("f_y, N").draw()?;
        chart.draw_series(LineSeries::new(section(&kx, PLANE), BLACK.stroke_width(2)))?;
        chart.draw_series(LineSeries::new(section(&found, PLANE), RED.stroke_width(1)))?;
    }
    area.present()?;
    Ok(())
}

/// Returns the components of K d in the plane of two axes, N, for deflections d of 1 mm in all directions of the plane.
fn section(stiffness: &Matrix3<f64>, [a, b]: [usize; 2]) -> Vec<(f64, f64)> {
    let of = |row, column| 0.1 * stiffness[(row, column)];
    let plane = Matrix2::new(of(a, a), of(a, b), of(b, a), of(b, b));
    let turned = |degrees: i32| {
        let (sin, cos) = f64::from(degrees).to_radians().sin_cos();
        let force = plane * Vector2::new(cos, sin);
        (force[0], force[1])
    };
    (0..=360).step_by(5).map(turned).collect()
}
