//! Cells as pixels.

use crate::report::base64::base64;

/// A PNG, as a data URI, of shares of the scale from 0 to 1, by rows from below;
/// NaN is transparent. The colours are viridis: evenly spaced to the eye, also
/// without colour, and to eyes that tell few.
pub fn picture(shares: &[f64], [width, height]: [usize; 2]) -> String {
    let mut pixels = Vec::with_capacity(4 * shares.len());
    for row in shares.chunks_exact(width).rev() {
        for &share in row {
            if share.is_nan() {
                pixels.extend([0; 4]);
            } else {
                let colour = colorous::VIRIDIS.eval_continuous(share);
                pixels.extend([colour.r, colour.g, colour.b, 255]);
            }
        }
    }
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width as u32, height as u32);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header().expect("memory takes any picture");
    writer.write_image_data(&pixels).expect("there are as many pixels as cells");
    writer.finish().expect("memory takes any picture");
    format!("data:image/png;base64,{}", base64(&file))
}
