//! The price list of `cargo xtask inspect --measure`, for people and as JSON.

use residual_driver::price::{Price, Step};
use residual_frontend::note;
use serde_json::{Value, json};

/// What is going on, while it takes its time.
pub(crate) fn say(step: Step) {
    match step {
        Step::Compiling {
            renderer,
            renderers,
        } => note!("renderer {renderer} of {renderers}"),
        Step::Measured {
            round,
            rounds,
            renders,
        } => note!("measured {round} of {rounds} rounds of {renders} renders"),
    }
}

/// A line of the list.
pub(crate) fn json(price: &Price) -> Value {
    json!({
        "effect": price.effect.to_string(),
        "in": price.is_in,
        "instead": price.instead,
        "time": price.time.median,
        "time_ci": price.time.interval,
        "flip": price.flip.value,
        "flip_ci95": price.flip.ci95,
        "relmse": price.relmse.value,
        "relmse_ci95": price.relmse.ci95,
    })
}

/// The list as a table.
pub(crate) fn table(prices: &[Price]) -> String {
    let mut text = format!(
        "{:<22} {:>7} {:>18}  {:>17}  {:>19}  {}\n",
        "effect", "time", "95 %", "FLIP", "relMSE", "compared with"
    );
    for price in prices {
        let percent = |part: f64| format!("{:+.1} %", 100.0 * part);
        text.push_str(&format!(
            "{:<22} {:>7} {:>18}  {:>7.4} ± {:>7.4}  {:>8.1e} ± {:>8.1e}  {}\n",
            price.effect.to_string(),
            percent(price.time.median),
            format!(
                "{} … {}",
                percent(price.time.interval[0]),
                percent(price.time.interval[1])
            ),
            price.flip.value,
            price.flip.ci95,
            price.relmse.value,
            price.relmse.ci95,
            price.instead,
        ));
    }
    text
}
