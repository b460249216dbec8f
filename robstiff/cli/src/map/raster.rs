//! Cells as pixels.

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

fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let number = (0..3).fold(0_u32, |number, k| number << 8 | u32::from(three.get(k).copied().unwrap_or(0)));
        for k in 0..4 {
            if k <= three.len() {
                text.push(char::from(DIGITS[(number >> (18 - 6 * k) & 63) as usize]));
            } else {
                text.push('=');
            }
        }
    }
    text
}

#[cfg(test)]
mod tests {
    #[test]
    fn base64_is_that_of_the_standard() {
        let text = ["", "f", "fo", "foo", "foob", "fooba", "foobar"].map(|text| super::base64(text.as_bytes()));
        assert_eq!(text, ["", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"]);
    }
}
