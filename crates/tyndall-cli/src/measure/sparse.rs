//! Some of a picture's pixels, for the reference takes seconds for all of them.

use tyndall::techniques::Technique;

use super::{DrawnFrame, Visibility, converged};
use crate::{failure::Failure, load::ShotFrame, picture::Picture, render::cpu};

/// Every so many pixels of every so many rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sparse {
    /// Pixels from one to the next across, and down; divides the picture's width and height.
    pub step: u32,
    /// The first one, below `step`.
    pub first: [u32; 2],
}

impl Sparse {
    /// These pixels of a picture of any kind, row by row.
    fn of<T: Copy>(self, pixels: &[T], size: [u32; 2]) -> Vec<T> {
        let [columns, rows] = [0, 1].map(|i| (self.first[i]..size[i]).step_by(self.step as usize));
        rows.flat_map(|y| columns.clone().map(move |x| (y * size[0] + x) as usize))
            .map(|index| pixels[index])
            .collect()
    }

    /// These pixels of a picture, as a picture.
    pub fn of_picture(self, picture: &Picture) -> Picture {
        Picture {
            size: picture.size.map(|side| side / self.step),
            pixels: self.of(&picture.pixels, picture.size),
        }
    }

    /// The place in the whole picture of one of these pixels.
    pub fn place(self, index: usize, width: u32) -> [u32; 2] {
        let columns = (width / self.step) as usize;
        let place = [index % columns, index / columns];
        [0, 1].map(|i| self.first[i] + self.step * place[i] as u32)
    }

    /// The frame whose pixels are these: a smaller picture, moved by parts of its pixels.
    fn frame(self, shot_frame: &ShotFrame) -> ShotFrame {
        let mut sparse = shot_frame.clone();
        sparse.size = shot_frame.size.map(|side| side / self.step);
        let moved = |i: usize| f64::from(self.first[i]) + 0.5 - 0.5 * f64::from(self.step);
        let camera = &shot_frame.frame.camera;
        sparse.frame.camera = camera.jittered(shot_frame.size, [moved(0), -moved(1)]);
        sparse
    }
}

impl DrawnFrame<'_> {
    /// Some pixels of the [`reference`](DrawnFrame::reference).
    ///
    /// # Errors
    /// [`Failure`], as for [`DrawnFrame::in_scatter`].
    pub fn sparse_reference(
        &self,
        visibility: Visibility,
        sparse: Sparse,
    ) -> Result<Picture, Failure> {
        self.sparse(
            &converged(visibility),
            sparse,
            visibility == Visibility::ShadowMap,
        )
    }

    /// Some pixels of the picture that would be taken for true if nothing blocked or tinted the lights.
    ///
    /// # Errors
    /// [`Failure`], as for [`DrawnFrame::in_scatter`].
    pub fn sparse_unshadowed(&self, sparse: Sparse) -> Result<Picture, Failure> {
        self.sparse(&converged(Visibility::ShadowMap), sparse, false)
    }

    fn sparse(
        &self,
        technique: &Technique,
        sparse: Sparse,
        shadow_maps: bool,
    ) -> Result<Picture, Failure> {
        let buffers = self.buffers()?;
        let depth = sparse.of(&buffers.depth, self.shot_frame.size);
        let shot_frame = sparse.frame(&self.shot_frame);
        let lights = self.light_inputs(buffers, shadow_maps);
        let pixels = cpu::in_scatter(
            &shot_frame,
            &technique.clone().into(),
            &depth,
            &lights,
            &|_, _| (),
        )?;
        Ok(Picture {
            size: shot_frame.size,
            pixels,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{backend::Backend, measure::tests::shot_frame, progress::Progress};

    #[test]
    fn some_pixels_are_those_of_the_whole_picture() {
        let shot_frame = shot_frame();
        let (backend, mut progress) = (Backend::Cpu, Progress::default());
        let drawn = DrawnFrame::new(&shot_frame, &backend, &mut progress).unwrap();
        let whole = drawn.reference(Visibility::ShadowMap).unwrap();
        let values = whole.pixels.as_flattened();
        let mean = values.iter().sum::<f32>() / values.len() as f32;
        for sparse in [
            Sparse {
                step: 4,
                first: [0, 3],
            },
            Sparse {
                step: 2,
                first: [1, 0],
            },
        ] {
            let found = drawn
                .sparse_reference(Visibility::ShadowMap, sparse)
                .unwrap();
            let expected = sparse.of_picture(&whole);
            assert_eq!(
                (found.size, found.pixels.len()),
                (expected.size, expected.pixels.len())
            );
            for (index, (a, b)) in found.pixels.iter().zip(&expected.pixels).enumerate() {
                let [x, y] = sparse.place(index, shot_frame.size[0]);
                assert_eq!(*b, whole.pixels[(y * shot_frame.size[0] + x) as usize]);
                // The camera's centre is rounded to f32.
                assert!((a[0] - b[0]).abs() < 1e-3 * mean, "{x}, {y}: {a:?}, {b:?}");
            }
        }
    }
}
