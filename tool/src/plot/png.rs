//! An SVG as PNG, with the embedded font.

use crate::failure::Failure;
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree};
use std::sync::Arc;

/// Subsets of DejaVu Sans. The licence is in tool/font/LICENSE.txt.
const FONTS: [&[u8]; 2] =
    [include_bytes!("../../font/DejaVuSans.ttf"), include_bytes!("../../font/DejaVuSans-Bold.ttf")];

/// Returns an SVG document as PNG. The picture has the width and height of the document in pixels.
pub fn draw(svg: &str) -> Result<Vec<u8>, Failure> {
    let mut options = Options { font_family: "DejaVu Sans".into(), ..Options::default() };
    for font in FONTS {
        Arc::make_mut(&mut options.fontdb).load_font_data(font.to_vec());
    }
    let tree = Tree::from_str(svg, &options)?;
    let size = tree.size().to_int_size();
    let mut pixels = Pixmap::new(size.width(), size.height())
        .ok_or("the picture has no size. This is a defect of sun2xp: please report it")?;
    resvg::render(&tree, Transform::identity(), &mut pixels.as_mut());
    Ok(pixels.encode_png()?)
}
