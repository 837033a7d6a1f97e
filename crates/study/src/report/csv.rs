//! The numbers of a report for other programs.

use residual_accuracy::Estimate;

use crate::findings::Findings;

/// A row for each configuration.
pub(super) fn configurations(findings: &Findings) -> String {
    let mut text = "configuration,axis,what,samples,seconds,seconds_low,seconds_high,relmse,relmse_low,relmse_high,\
                    slope,slope_ci95,squared_bias,squared_bias_ci95,seconds_to_1_percent,seconds_to_1_percent_low,\
                    seconds_to_1_percent_high,relative_time,relative_time_low,relative_time_high,efficiency,efficiency_low,\
                    efficiency_high\n"
        .to_owned();
    for finding in &findings.configurations {
        let levels = finding.series.levels();
        let last = levels.last().expect("runs were looked at");
        let estimate = |e: Estimate| [Some(e.median), Some(e.interval[0]), Some(e.interval[1])];
        let slope = finding.slope.map(|s| [s.value, s.ci95]);
        let time = finding.to_one_percent.map(|t| [t.value, t.low, t.high]);
        let mut numbers = Vec::new();
        numbers.extend(estimate(last.seconds));
        numbers.extend(estimate(last.error));
        numbers.extend((0..2).map(|k| slope.map(|s| s[k])));
        numbers.extend([Some(finding.bias.value), Some(finding.bias.ci95)]);
        numbers.extend((0..3).map(|k| time.map(|t| t[k])));
        numbers.extend(estimate(finding.time));
        numbers.extend(estimate(finding.efficiency));
        let configuration = finding.configuration;
        let fields = [
            quoted(configuration.name),
            quoted(configuration.axis.title()),
            quoted(configuration.what),
            last.samples.to_string(),
        ];
        // What is not known is an empty field.
        let numbers = numbers
            .into_iter()
            .map(|n| n.map_or(String::new(), |n| format!("{n:e}")));
        let row: Vec<_> = fields.into_iter().chain(numbers).collect();
        text.push_str(&row.join(","));
        text.push('\n');
    }
    text
}

/// A row for each look at a run.
pub(super) fn measurements(findings: &Findings) -> String {
    let mut text = "configuration,run,samples,seconds,relmse\n".to_owned();
    for finding in &findings.configurations {
        for (run, measured) in finding.series.runs().iter().enumerate() {
            for m in measured {
                text.push_str(&format!(
                    "{},{},{},{:e},{:e}\n",
                    quoted(finding.configuration.name),
                    run + 1,
                    m.samples,
                    m.seconds,
                    m.error
                ));
            }
        }
    }
    text
}

/// A field of text (RFC 4180).
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::quoted;

    #[test]
    fn fields_are_quoted_where_they_must_be() {
        assert_eq!(
            [quoted("a b"), quoted("a, \"b\"")],
            ["a b", "\"a, \"\"b\"\"\""]
        );
    }
}
