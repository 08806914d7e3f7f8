//! Stage "scatter": chooses where each path goes on.

use super::batch::Batch;
use super::group::{Entry, GroupStage};
use super::path::Path;
use super::{RayKind, SCATTERED_SPREAD, Tracer, Vertex};
use crate::accel::Accelerator;
use crate::bsdf::Scatter;
use crate::geometry::Ray;
use crate::sampling::Dimension;

/// What the stage reads and writes.
pub(super) struct ScatterStage<'a, 't, A> {
    pub(super) tracer: &'a Tracer<'t, A>,
    pub(super) vertices: &'a [Vertex],
    /// What each vertex draws its direction from.
    pub(super) directions: &'a [[f32; 2]],
    pub(super) slots: &'a mut [Path],
    /// Slots of paths that go on.
    pub(super) active: &'a mut Batch<u32>,
    /// Slots of paths that end here.
    pub(super) finished: &'a mut Batch<u32>,
}

impl<A: Accelerator> GroupStage for ScatterStage<'_, '_, A> {
    fn visit<M: Scatter>(&mut self, group: &[Entry<M>]) {
        for entry in group {
            let vertex = &self.vertices[entry.vertex as usize];
            let direction = self.directions[entry.vertex as usize];
            let path = &mut self.slots[vertex.slot as usize];
            let goes_on = scatter(path, vertex, &entry.model, direction, self.tracer);
            let list = if goes_on { &mut *self.active } else { &mut *self.finished };
            list.push(vertex.slot);
        }
    }
}

/// Samples the model and sets the path's next ray; false where the path ends.
#[inline]
fn scatter<M: Scatter, A: Accelerator>(
    path: &mut Path,
    vertex: &Vertex,
    model: &M,
    direction: [f32; 2],
    tracer: &Tracer<'_, A>,
) -> bool {
    let bounce = path.bounce;
    let lobe = match M::HAS_LOBES {
        true => tracer.sampler.one(path.key, Dimension::ScatterLobe { bounce }),
        false => 0.0,
    };
    let Some(sample) = model.sample(vertex.wo, lobe, direction) else {
        return false;
    };
    let wi = vertex.at.frame.world_from_local(sample.wi);
    // Shading and geometric normal must agree on which side the path goes on, or light would leak.
    if (sample.wi.z > 0.0) != (vertex.at.n_geometric.dot(wi) > 0.0) {
        return false;
    }
    path.throughput *= sample.weight;
    if path.throughput.is_black() {
        return false;
    }
    if !path.happens(sample.kind, sample.is_delta, &tracer.plan.pipeline) {
        return false;
    }
    if sample.wi.z < 0.0 {
        path.absorption = tracer.absorption_beyond(&vertex.at);
    }
    if !sample.is_delta {
        path.cone_spread += SCATTERED_SPREAD;
    }
    path.pdf_solid_angle = sample.pdf_solid_angle;
    path.is_delta = sample.is_delta;
    path.eta_scale *= sample.eta_scale;
    path.bounce += 1;
    path.ray = Ray::new(vertex.at.origin_towards(wi), wi);
    path.ray.id = tracer.ray_id(path.key, path.bounce, RayKind::Path);
    true
}
