//! The phase function again, of corrected pixels alone, each drawn as a point.

use super::resources::{Image, List, Resources, buffer, texture};
use crate::gpu::{
    pass::{FullScreen, Pass, Work},
    program::{Raster, ScreenProgram},
    scope::{LightScope, Shared},
};

pub(super) struct FinishPoints(ScreenProgram);

impl FinishPoints {
    pub(super) fn new(device: &wgpu::Device, shared: &Shared) -> Self {
        let module = "techniques::epipolar_sampling::finish_points";
        let points = Raster {
            vertex: "finish_point",
            topology: wgpu::PrimitiveTopology::PointList,
            ..Raster::full_screen(shared.output.into())
        };
        Self(ScreenProgram::new(device, shared, module, "finish").drawing(points))
    }

    pub(super) fn pass(&self, scope: &LightScope<'_>, r: &Resources, image: &Image) -> Pass {
        let resources = [
            buffer(&r.params),
            texture(&image.values),
            buffer(&image.list),
        ];
        let points = FullScreen {
            gate: Some(r.points(List::Coarse)),
            ..scope.draw(&self.0, &resources, scope.target.clone())
        };
        Pass {
            name: scope.pass_name("corrected pixels"),
            work: Work::FullScreen(vec![points]),
        }
    }
}
