//! `cargo xtask cache`.

use anyhow::Result;
use residual_driver::cache::Cache;
use residual_frontend::out;

use crate::args::CacheCommand;

pub(crate) fn run(command: CacheCommand) -> Result<()> {
    let cache = Cache::open();
    let entries = cache.entries()?;
    let bytes: u64 = entries.iter().map(|entry| entry.bytes).sum();
    let mib = |bytes: u64| bytes as f64 / f64::from(1 << 20);
    match command {
        CacheCommand::List => {
            for entry in &entries {
                let age = entry.used.elapsed().unwrap_or_default().as_secs();
                out!(
                    "{}  {:>6.1} MiB  used {:>4} h {:>2} min ago  {}",
                    entry.key(),
                    mib(entry.bytes),
                    age / 3600,
                    age / 60 % 60,
                    entry.title()
                );
            }
            out!(
                "{} compiled renderers, {:.1} of at most {:.0} MiB (RESIDUAL_CACHE_MIB), in {}",
                entries.len(),
                mib(bytes),
                mib(cache.bound()),
                cache.directory().display()
            );
        }
        CacheCommand::Clear => {
            cache.clear()?;
            out!(
                "removed {} compiled renderers, {:.1} MiB",
                entries.len(),
                mib(bytes)
            );
        }
    }
    Ok(())
}
