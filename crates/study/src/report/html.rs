//! The page.

use anyhow::Result;
use residual_frontend::precision::percent;

use super::chart::{self, escaped};
use super::crops::Window;
use super::{error_figure, ladder_figure, numbers, pareto_figure};
use crate::configuration::{Axis, NOT_MEASURED, Removes, Tier};
use crate::findings::{Finding, Findings, Level, Study};

const TEMPLATE: &str = include_str!("template.html");
const PAGE_STYLE: &str = include_str!("page.css");

/// The whole page.
pub(super) fn report(study: &Study, findings: &Findings) -> Result<String> {
    let title = escaped(&format!("What accuracy costs: {}", study.scene));
    let charts: Vec<_> = Axis::SWITCHED
        .into_iter()
        .filter_map(|axis| {
            let drawing = error_figure::of_axis(findings, axis)?;
            Some(chart::inline(&drawing, axis.title()))
        })
        .collect();
    let pareto = chart::inline(&pareto_figure::figure(findings), "Pareto front");
    let ladder = chart::inline(&ladder_figure::figure(findings), "truth ladder");
    let window = Window::of(study)?;
    let replacements = [
        ("title", title),
        ("chart style", chart::STYLE.to_owned()),
        ("page style", PAGE_STYLE.to_owned()),
        ("facts", escaped(&facts(study))),
        ("answer", answer(study, findings)),
        ("error charts", charts.concat()),
        ("pareto chart", pareto),
        ("ladder chart", ladder),
        ("ladder table", ladder_table(findings)),
        ("crops text", crops_text(study)),
        ("crops", crops(study, &window)?),
        ("configuration table", configuration_table(findings)),
        ("method", method(study, findings)),
        ("not measured", not_measured()),
    ];
    let mut page = TEMPLATE.to_owned();
    for (name, text) in replacements {
        page = page.replace(&format!("{{{{{name}}}}}"), &text);
    }
    Ok(page)
}

fn facts(study: &Study) -> String {
    let [width, height] = study.reference.size;
    let tier = match study.tier {
        Tier::Interpreted => "interpreted",
        Tier::Specialized => "specialised",
    };
    format!(
        "{} triangles, {width} × {height} pixels, {tier}, {} {}; {}; commit {}",
        study.triangles,
        study.threads,
        if study.threads == 1 {
            "thread"
        } else {
            "threads"
        },
        study.provenance.machines.join("; "),
        study.provenance.commits.join(", "),
    )
}

/// What most readers want to know.
fn answer(study: &Study, findings: &Findings) -> String {
    let baseline = &findings.configurations[0];
    let levels = baseline.series.levels();
    let last = levels.last().expect("runs were looked at");
    let mut lines = vec![
        format!(
            "By default, {} samples a pixel take {} of CPU time and err by {} (root of the relative mean squared error).",
            last.samples,
            numbers::time(last.seconds.median),
            percent(last.error.median)
        ),
        match baseline.to_one_percent {
            Some(_) => format!(
                "An error of 1 % takes {}.",
                numbers::interval(baseline.to_one_percent)
            ),
            None => "An error of 1 % is never reached: the bias is above it.".to_owned(),
        },
        format!(
            "The bias of the default is {}: what no number of samples removes.",
            numbers::bias(baseline.relative_bias())
        ),
    ];
    for rung in &findings.ladder {
        if let (Removes::Misses(..), Level::Seen { value, .. }) =
            (rung.switch.removes, rung.without)
        {
            lines.push(format!(
                "Of a million rays aimed at edges, {} pass between triangles without {}, which changes the time by {}.",
                numbers::digits(1e6 * value),
                rung.switch.name,
                numbers::change(rung.time.median)
            ));
        }
    }
    let mut text: String = lines
        .iter()
        .map(|line| format!("<p>{}</p>\n", escaped(line)))
        .collect();
    if !study.reference.is_trusted() {
        text.push_str("<p class=\"warning\">The strategies of the reference disagree by more than their noise: do not trust these numbers.</p>\n");
    }
    text
}

fn table(head: &[&str], rows: impl Iterator<Item = Vec<String>>) -> String {
    let cells = |tag: &str, cells: Vec<String>| -> String {
        let cells = cells
            .iter()
            .map(|cell| format!("<{tag}>{}</{tag}>", escaped(cell)));
        format!("<tr>{}</tr>\n", cells.collect::<String>())
    };
    let head = cells("th", head.iter().map(|&cell| cell.to_owned()).collect());
    let rows: String = rows.map(|row| cells("td", row)).collect();
    format!("<table>\n{head}{rows}</table>\n")
}

fn ladder_table(findings: &Findings) -> String {
    let rows = findings.ladder.iter().map(|rung| {
        let [low, high] = rung.time.interval.map(numbers::change);
        let (what, level): (_, fn(_) -> _) = match rung.switch.removes {
            Removes::Misses(..) => ("misses per aimed ray", numbers::rate),
            Removes::Bias => ("bias", numbers::bias),
            Removes::Stagnation => ("error of the sum of 2²⁴ samples", numbers::bias),
        };
        vec![
            rung.switch.name.to_owned(),
            format!("{} ({low} to {high})", numbers::change(rung.time.median)),
            what.to_owned(),
            level(rung.without),
            level(rung.with),
        ]
    });
    table(
        &["switch", "time", "what it removes", "without", "with"],
        rows,
    )
}

fn configuration_table(findings: &Findings) -> String {
    let row = |finding: &Finding| {
        let levels = finding.series.levels();
        let last = levels.last().expect("runs were looked at");
        let of = |e: residual_accuracy::Estimate| {
            format!(
                "{:.3} ({:.3} to {:.3})",
                e.median, e.interval[0], e.interval[1]
            )
        };
        vec![
            finding.configuration.name.to_owned(),
            finding.configuration.what.to_owned(),
            percent(last.error.median),
            numbers::jackknifed(finding.slope),
            numbers::bias(finding.relative_bias()),
            of(finding.time),
            of(finding.efficiency),
            numbers::interval(finding.to_one_percent),
        ]
    };
    let samples = findings.configurations[0].series.levels();
    let error = format!(
        "error at {}",
        samples.last().expect("runs were looked at").samples
    );
    let head = [
        "configuration",
        "",
        &error,
        "slope",
        "bias",
        "time",
        "efficiency",
        "CPU time to 1 %",
    ];
    table(&head, findings.configurations.iter().map(row))
}

fn crops_text(study: &Study) -> String {
    let time = numbers::time(study.crops[0].seconds);
    escaped(&format!(
        "The part of the image in which the first one errs the most, each after about {time} of CPU time. The error is that of the whole image."
    ))
}

fn crops(study: &Study, window: &Window) -> Result<String> {
    let figure = |picture: String, name: &str, text: &str| {
        let (name, text) = (escaped(name), escaped(text));
        format!("<figure>{picture}<figcaption><b>{name}</b><br>{text}</figcaption></figure>\n")
    };
    let picture = window.of_reference(&study.reference)?;
    let mut all = figure(
        picture,
        "reference",
        &format!("{} samples", study.reference.samples),
    );
    for crop in &study.crops {
        let text = format!(
            "{} samples, {}, error {}",
            crop.samples,
            numbers::time(crop.seconds),
            percent(crop.error)
        );
        all.push_str(&figure(
            window.of_crop(crop)?,
            crop.configuration.name,
            &text,
        ));
    }
    Ok(all)
}

fn list(items: impl Iterator<Item = String>) -> String {
    let items: String = items
        .map(|item| format!("<li>{}</li>\n", escaped(&item)))
        .collect();
    format!("<ul>\n{items}</ul>\n")
}

fn method(study: &Study, findings: &Findings) -> String {
    let reference = &study.reference;
    let counts: Vec<_> = findings.configurations[0]
        .series
        .levels()
        .iter()
        .map(|level| level.samples.to_string())
        .collect();
    let mut items = vec![
        format!(
            "{} runs of each configuration, with the seeds {} to {}, looked at after {} samples. Configurations take turns, seed by seed; times are CPU times of the process without compiling, building the hierarchy and looking.",
            study.seeds.len(),
            study.seeds.first().unwrap_or(&0),
            study.seeds.last().unwrap_or(&0),
            counts.join(", ")
        ),
        format!(
            "The reference has {} samples a pixel, of {} seeds that no run has, and paths that only roulette ends. Its variance is that over seeds, and is subtracted from all errors.",
            reference.samples,
            reference.seeds.len()
        ),
    ];
    for agreement in &reference.agreements {
        items.push(format!(
            "Its strategies {} and {} {}: the mean square of their differences over blocks, in units of their noise, is {:.2}, and the largest would be as large by chance with a probability of {}.",
            agreement.between[0],
            agreement.between[1],
            if agreement.holds() { "agree" } else { "disagree" },
            agreement.mean_square,
            numbers::digits(agreement.probability)
        ));
    }
    items.extend([
        "Errors are relative mean squared errors: the mean of (x − r)² / (r² + ε), with ε a hundredth of the squared mean. The bias comes from products of the errors of different seeds, in which noise has no expectation. Where it is certain it is taken for the floor of the fit, error = bias² + v · time^−β; configurations that converge to the same as the default have its floor.".to_owned(),
        "Medians have the interval between order statistics (below six runs, of all runs), slopes, biases and times to 1 % that of the jackknife over seeds, times with the uncertainty of the floor, all of 95 %. One interval in twenty misses: of so many rows, some do.".to_owned(),
        "All configurations have the same seeds. That makes differences certain; the rows are not independent of each other.".to_owned(),
        "Misses are of this scene's triangles, seen from both sides, by rays that are aimed at edges of two triangles; images meet edges so closely once in a million rays or less. Nothing seen in n rays bounds the rate by 3 / n.".to_owned(),
    ]);
    if let Some(sums) = &study.sums {
        let errors: Vec<_> = sums
            .errors
            .iter()
            .map(|(count, error)| {
                format!(
                    "{} after 2{}",
                    numbers::percent(*error),
                    super::numbers::superscript(&count.trailing_zeros().to_string())
                )
            })
            .collect();
        items.push(format!(
            "Sums in f32 of samples from the middle of the image, added again and again, are off by {}.",
            errors.join(", ")
        ));
    }
    list(items.into_iter())
}

fn not_measured() -> String {
    list(
        NOT_MEASURED
            .iter()
            .map(|(what, why)| format!("{what}: {why}")),
    )
}
