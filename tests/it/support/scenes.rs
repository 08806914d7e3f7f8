//! Small scenes built in code, and views of them.

#![cfg(feature = "embree")]

use super::shot::Shot;
use glint::film::Pixels;
use glint::math::{DAffine3, DMat3, DVec3, Rgb};
use glint::scene::{
    ColorInput, Emission, Environment, Light, Material, MaterialId, MeshData, Model, ModelId,
    Placement, ScalarInput, Scene, Surface,
};
use glint::world::World;
use std::sync::Arc;

/// A scene under construction.
#[derive(Default)]
pub(crate) struct Builder {
    pub(crate) scene: Scene,
}

impl Builder {
    pub(crate) fn material(&mut self, surface: Surface) -> MaterialId {
        self.scene.materials.push(Material::new("test", surface));
        MaterialId(self.scene.materials.len() as u32 - 1)
    }

    pub(crate) fn lambert(&mut self, r: f32, g: f32, b: f32) -> MaterialId {
        self.material(Surface::Lambert { albedo: ColorInput::constant(Rgb::new(r, g, b)) })
    }

    pub(crate) fn emitter(&mut self, albedo: f32, radiance: Rgb) -> MaterialId {
        let id = self.lambert(albedo, albedo, albedo);
        let emission = Emission { radiance: ColorInput::constant(radiance) };
        self.scene.materials[id.index()].emission = Some(emission);
        id
    }

    pub(crate) fn environment(&mut self, radiance: Rgb) {
        self.scene.environment = Some(Environment::Constant { radiance });
    }

    /// Adds a mesh of triangles, placed as it is.
    pub(crate) fn mesh(&mut self, mesh: MeshData) -> ModelId {
        self.scene.models.push(Model {
            name: "test".into(),
            location: None,
            meshes: vec![Arc::new(mesh)],
        });
        let model = ModelId(self.scene.models.len() as u32 - 1);
        self.place(model, DAffine3::IDENTITY);
        model
    }

    pub(crate) fn place(&mut self, model: ModelId, world_from_object: DAffine3) {
        let placement = Placement { model, world_from_object, material_override: None };
        self.scene.placements.push(placement);
    }

    /// The parallelogram corner, corner + a, corner + a + b, corner + b; its winding faces a x b.
    pub(crate) fn quad(&mut self, corner: [f32; 3], a: [f32; 3], b: [f32; 3], m: MaterialId) {
        let add = |p: [f32; 3], q: [f32; 3]| [p[0] + q[0], p[1] + q[1], p[2] + q[2]];
        let positions = vec![corner, add(corner, a), add(add(corner, a), b), add(corner, b)];
        self.mesh(MeshData {
            positions,
            uvs: vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            materials: vec![m; 2],
            ..MeshData::default()
        });
    }

    /// A closed sphere of 2 n (n - 1) triangles, winding outward, with smooth normals if asked for.
    pub(crate) fn sphere(
        &mut self,
        center: [f32; 3],
        radius: f32,
        n: u32,
        smooth: bool,
        m: MaterialId,
    ) {
        let mut mesh = sphere_mesh(radius, n, smooth, m);
        for p in &mut mesh.positions {
            (0..3).for_each(|k| p[k] += center[k]);
        }
        self.mesh(mesh);
    }

    pub(crate) fn build(self) -> World {
        World::compile(self.scene).expect("the scene compiles")
    }
}

pub(crate) fn sphere_mesh(radius: f32, n: u32, smooth: bool, m: MaterialId) -> MeshData {
    use std::f64::consts::PI;
    let mut unit = vec![[0.0_f32, 0.0, 1.0]];
    for i in 1..n {
        for j in 0..2 * n {
            let (theta, phi) = (PI * f64::from(i) / f64::from(n), PI * f64::from(j) / f64::from(n));
            let p = [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()];
            unit.push(p.map(|x| x as f32));
        }
    }
    unit.push([0.0, 0.0, -1.0]);
    let last = unit.len() as u32 - 1;
    let at = |i: u32, j: u32| 1 + (i - 1) * 2 * n + j % (2 * n);
    let mut triangles = Vec::new();
    for j in 0..2 * n {
        triangles.push([0, at(1, j), at(1, j + 1)]);
        for i in 1..n - 1 {
            triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
        triangles.push([at(n - 1, j), last, at(n - 1, j + 1)]);
    }
    MeshData {
        positions: unit.iter().map(|p| p.map(|x| x * radius)).collect(),
        normals: if smooth { unit } else { Vec::new() },
        materials: vec![m; triangles.len()],
        triangles,
        ..MeshData::default()
    }
}

/// Mean of all pixels.
pub(crate) fn mean(pixels: &Pixels) -> [f64; 3] {
    [0, 1, 2].map(|c| {
        pixels.radiance.iter().map(|p| f64::from(p[c])).sum::<f64>() / pixels.radiance.len() as f64
    })
}

/// The Cornell box in metres: 2 x 2 x 2 around (0, 1, 0), open towards +z, with a lamp and two boxes' worth
/// of spheres.
pub(crate) fn cornell() -> Builder {
    let mut b = Builder::default();
    let white = b.lambert(0.73, 0.73, 0.73);
    let red = b.lambert(0.63, 0.06, 0.05);
    let green = b.lambert(0.12, 0.45, 0.09);
    let lamp = b.emitter(0.0, Rgb::new(18.0, 13.0, 5.0));
    b.quad([-1.0, 0.0, -1.0], [0.0, 0.0, 2.0], [2.0, 0.0, 0.0], white);
    b.quad([-1.0, 2.0, -1.0], [2.0, 0.0, 0.0], [0.0, 0.0, 2.0], white);
    b.quad([-1.0, 0.0, -1.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], white);
    b.quad([-1.0, 0.0, -1.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0], red);
    b.quad([1.0, 0.0, -1.0], [0.0, 0.0, 2.0], [0.0, 2.0, 0.0], green);
    b.quad([-0.3, 1.99, -0.3], [0.6, 0.0, 0.0], [0.0, 0.0, 0.6], lamp);
    b.sphere([-0.4, 0.4, -0.3], 0.4, 16, true, white);
    b.sphere([0.45, 0.3, 0.3], 0.3, 12, false, white);
    b
}

/// A view into [`cornell`].
pub(crate) fn cornell_shot(size: [u32; 2], spp: u64) -> Shot {
    Shot::new([0.0, 1.0, 4.8], [0.0, 1.0, 0.0], 30.0, size, spp)
}

/// One of everything: every surface, cut-outs, instances, and every kind of light.
pub(crate) fn zoo() -> Builder {
    let mut b = Builder::default();
    let c = |r, g, b| ColorInput::constant(Rgb::new(r, g, b));
    let n = ScalarInput::constant;
    let floor = b.material(Surface::OrenNayar { albedo: c(0.5, 0.5, 0.45), sigma: 0.5 });
    b.quad([-5.0, 0.0, -5.0], [0.0, 0.0, 10.0], [10.0, 0.0, 0.0], floor);
    let glass = |roughness, absorption| Surface::Dielectric {
        eta: 1.5,
        roughness: n(roughness),
        absorption,
        transmittance: Rgb::WHITE,
        thin: false,
    };
    let surfaces = [
        Surface::Lambert { albedo: c(0.7, 0.3, 0.2) },
        Surface::Mirror { reflectance: c(0.9, 0.9, 0.9) },
        glass(0.0, Rgb::new(0.1, 0.5, 1.0)),
        glass(0.4, Rgb::BLACK),
        Surface::Conductor {
            eta: Rgb::new(0.2, 0.9, 1.1),
            k: Rgb::new(3.9, 2.4, 2.2),
            roughness: n(0.4),
            anisotropy: 0.3,
        },
        Surface::Plastic { albedo: c(0.1, 0.3, 0.7), eta: 1.5, roughness: n(0.2) },
        Surface::Principled {
            base_color: c(0.8, 0.6, 0.1),
            metallic: n(0.5),
            roughness: n(0.3),
            specular: c(0.04, 0.04, 0.04),
            anisotropy: 0.0,
            clearcoat: 0.5,
            clearcoat_roughness: 0.1,
            sheen: 0.3,
        },
    ];
    for (i, surface) in surfaces.into_iter().enumerate() {
        let m = b.material(surface);
        let x = i as f32 - 3.0;
        b.sphere([x, 0.45, 0.2 * x], 0.45, 12, i % 2 == 0, m);
    }
    // Half-covered quads in front, as instances of one model.
    let leaf = b.lambert(0.2, 0.6, 0.2);
    b.scene.materials[leaf.index()].opacity = n(0.5);
    b.quad([-0.4, 0.0, 0.0], [0.8, 0.0, 0.0], [0.0, 0.8, 0.0], leaf);
    let model = b.scene.placements.pop().expect("the quad was placed").model;
    for i in 0..5 {
        let at = DVec3::new(f64::from(i) * 1.2 - 2.4, 0.0, 1.5);
        let turn =
            DMat3::from_cols(DVec3::new(0.8, 0.0, -0.6), DVec3::Y, DVec3::new(0.6, 0.0, 0.8));
        b.place(model, DAffine3 { matrix3: turn, translation: at });
    }
    let lamp = b.emitter(0.0, Rgb::new(8.0, 6.0, 4.0));
    b.quad([-1.0, 3.0, -1.0], [1.0, 0.0, 0.0], [0.0, 0.2, 1.0], lamp);
    let position = DVec3::new(2.0, 3.0, 2.0);
    b.scene.lights = vec![
        Light::Point { position, intensity: Rgb::splat(3.0) },
        Light::Spot {
            position,
            direction: -position,
            intensity: Rgb::splat(20.0),
            outer_angle: 30.0,
            inner_angle: 10.0,
        },
        Light::Directional {
            direction: DVec3::new(1.0, -1.0, 0.5),
            irradiance: Rgb::splat(1.0),
            angular_diameter: 3.0,
        },
    ];
    b.scene.environment = Some(Environment::Sky {
        elevation: 30.0,
        azimuth: 45.0,
        turbidity: 3.0,
        ground_albedo: Rgb::splat(0.3),
        scale: 0.5,
    });
    b
}

/// A view of [`zoo`].
pub(crate) fn zoo_shot(size: [u32; 2], spp: u64) -> Shot {
    Shot::new([0.0, 2.0, 8.0], [0.0, 0.6, 0.0], 35.0, size, spp)
}
