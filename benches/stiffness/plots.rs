//! Step responses, and commanded against apparent stiffness, as SVG.

use crate::cases::Case;
use crate::{motion, statics};
use nalgebra::{Matrix2, Matrix3, Vector2};
use plotters::prelude::*;
use std::error::Error;
use std::path::Path;
use sun2xp::model::configuration::Scheme;

const RATE: f64 = 1000.0;
const POSES: usize = 6;

/// Draws into `folder`: `step-response.svg` and `stiffness-ellipses.svg`, one panel a controller, at 1000 Hz.
pub fn draw(folder: &Path, schemes: &[Scheme], seed: u64) -> Result<(), Box<dyn Error>> {
    std::fs::create_dir_all(folder)?;
    let cases: Vec<Case> = schemes.iter().map(|&scheme| Case { scheme, rate: RATE, poses: POSES, seed }).collect();
    step_responses(&folder.join("step-response.svg"), &cases)?;
    ellipses(&folder.join("stiffness-ellipses.svg"), &cases)
}

fn step_responses(file: &Path, cases: &[Case]) -> Result<(), Box<dyn Error>> {
    let area = SVGBackend::new(file, (520 * cases.len() as u32, 360)).into_drawing_area();
    area.fill(&WHITE)?;
    for (panel, case) in area.split_evenly((1, cases.len())).iter().zip(cases) {
        let mut chart = ChartBuilder::on(panel)
            .caption(format!("5 mm step, Kx 3, {}", case.name()), ("sans-serif", 16))
            .margin(8)
            .x_label_area_size(34)
            .y_label_area_size(44)
            .build_cartesian_2d(0.0..0.6, -0.2..1.6)?;
        chart.configure_mesh().x_desc("s").y_desc("part of the step").draw()?;
        for pose in 0..POSES {
            let response = motion::step_response(case, pose, 3.0, 0.6);
            chart.draw_series(LineSeries::new(response, Palette99::pick(pose).stroke_width(1)))?;
        }
    }
    area.present()?;
    Ok(())
}

/// The displacements that 1 N in every direction of the x-z plane wants (black) and finds (red), one drawing a pose.
fn ellipses(file: &Path, cases: &[Case]) -> Result<(), Box<dyn Error>> {
    let kx = Matrix3::from_diagonal(&nalgebra::Vector3::new(1.0, 5.0, 2.0));
    let area = SVGBackend::new(file, (180 * POSES as u32, 210 * cases.len() as u32)).into_drawing_area();
    area.fill(&WHITE)?;
    let panels = area.split_evenly((cases.len(), POSES));
    for (panel, number) in panels.iter().zip(0..) {
        let (case, pose) = (&cases[number / POSES], number % POSES);
        let found = statics::compliance(case, &case.poses()[pose], &kx);
        let wanted = kx.map(|entry| if entry > 0.0 { 1.0 / entry } else { 0.0 });
        let mut chart = ChartBuilder::on(panel)
            .caption(format!("{:?}", case.scheme), ("sans-serif", 12))
            .margin(6)
            .x_label_area_size(20)
            .y_label_area_size(28)
            .build_cartesian_2d(-1.2..1.2, -1.2..1.2)?;
        chart.configure_mesh().x_labels(3).y_labels(3).disable_mesh().draw()?;
        chart.draw_series(LineSeries::new(ellipse(&wanted), BLACK.stroke_width(2)))?;
        chart.draw_series(LineSeries::new(ellipse(&found), RED.stroke_width(1)))?;
    }
    area.present()?;
    Ok(())
}

/// C f for f around the unit circle of the x-z plane, cm.
fn ellipse(compliance: &Matrix3<f64>) -> Vec<(f64, f64)> {
    let plane = Matrix2::new(compliance[(0, 0)], compliance[(0, 2)], compliance[(2, 0)], compliance[(2, 2)]);
    let turned = |degrees: i32| {
        let (sin, cos) = f64::from(degrees).to_radians().sin_cos();
        let moved = plane * Vector2::new(cos, sin);
        (moved[0], moved[1])
    };
    (0..=360).step_by(5).map(turned).collect()
}
