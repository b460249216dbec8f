//! The loop from code: measured loads in, a better description out.
//!
//!     cargo run --release -p robstiff-identify --example trace

use std::error::Error;
use std::path::Path;

use robstiff_identify::campaign::Campaign;
use robstiff_identify::predict::predict;
use robstiff_identify::trace::{Options, trace};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots/measured/fanuc-r2000ic");
    let campaign = Campaign::read(folder.join("campaign.yaml"))?;
    let traced = trace(&campaign, &Options::default(), &|_| ())?;

    println!("{}: {}", traced.verdict, traced.why);
    for named in &traced.effects {
        println!("  {}, probability {:.3}", named.effect, named.probability);
        for parameter in &named.effect.parameters {
            println!("    {} = {:.3e} {}", parameter.name, parameter.value, parameter.unit);
        }
    }
    // On poses that the fit has not seen.
    let [before, after] = [traced.identified, traced.after].map(|misfit| misfit.holdout_rms * 1e6);
    println!("error on unseen poses: {before:.1} um with the joints alone, {after:.1} um with the effects");

    // What it found goes into the description, and from there into `robot!`.
    println!("\n{}", traced.description.to_yaml());
    let all_rows = predict(&traced.description, &campaign)?;
    println!("the description alone, without the faults of the rig: {:.1} um on all rows", all_rows.rms * 1e6);
    Ok(())
}
