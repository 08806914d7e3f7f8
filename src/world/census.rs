//! The census: what in the compiled scene calls for which effects, and who is the first to do so.
//!
//! Only what a ray can reach counts: a material that no placed triangle shows calls for nothing. Decides
//! nothing: that is the plan's.

use super::World;
use crate::bsdf::{Bsdf, RoughDielectric};
use crate::error::Location;
use crate::light::LightKind;
use crate::scene::{ColorInput, Material, MaterialId, ScalarInput, Surface};
use std::borrow::Cow;
use std::path::Path;

/// What a scene can call for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Feature {
    /// Points and spots.
    PointLight,
    /// Single directions.
    Direction,
    /// Discs at infinity.
    Sun,
    /// Emissive surfaces.
    Emission,
    /// A constant environment.
    Constant,
    /// An image around the scene.
    Image,
    /// Broad reflection.
    Diffuse,
    /// Reflection from rough interfaces.
    Glossy,
    /// Reflection from smooth interfaces.
    Mirror,
    /// Transmission through smooth interfaces.
    Refraction,
    /// Transmission through rough interfaces.
    RoughRefraction,
    /// Media that keep light.
    Absorption,
    /// Images on surfaces.
    Texture,
    /// Normal and bump maps.
    NormalMap,
    /// Parts of surfaces that are not there.
    CutOut,
    /// Models that are placed more than once.
    Instancing,
}

const FEATURES: usize = Feature::Instancing as usize + 1;

/// Who calls for a feature.
#[derive(Clone, Debug, PartialEq)]
pub struct Witness {
    /// The first of them, in words.
    pub first: String,
    /// Where it is defined, if in a file.
    pub location: Option<Location>,
    /// How many there are.
    pub count: usize,
}

/// What is in a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Census {
    found: [Option<Witness>; FEATURES],
}

impl Census {
    /// Who calls for `feature`, if anyone does.
    pub fn witness(&self, feature: Feature) -> Option<&Witness> {
        self.found[feature as usize].as_ref()
    }

    /// Whether anyone calls for `feature`.
    pub fn has(&self, feature: Feature) -> bool {
        self.witness(feature).is_some()
    }

    /// Whether anyone calls for any of `features`.
    pub fn has_any(&self, features: &[Feature]) -> bool {
        features.iter().any(|&feature| self.has(feature))
    }

    fn add(&mut self, feature: Feature, first: impl Fn() -> String, location: &Option<Location>) {
        let new = || Witness { first: first(), location: location.clone(), count: 0 };
        self.found[feature as usize].get_or_insert_with(new).count += 1;
    }
}

impl World {
    /// Counts what there is.
    pub fn census(&self) -> Census {
        let mut census = Census::default();
        for (kind, location) in self.lights.lit() {
            let (feature, name) = match kind {
                LightKind::Point => (Feature::PointLight, "point light"),
                LightKind::Spot => (Feature::PointLight, "spot light"),
                LightKind::Direction => (Feature::Direction, "directional light"),
                LightKind::Disc => (Feature::Sun, "directional light with a disc"),
                LightKind::Constant => (Feature::Constant, "constant environment"),
                LightKind::Image => (Feature::Image, "sky or image around the scene"),
                LightKind::Surface => continue,
            };
            census.add(feature, || name.into(), location);
        }
        let shown = self.shown_materials();
        for (id, material) in self.materials.iter().enumerate().filter(|(id, _)| shown[*id]) {
            for (feature, is_called_for) in self.called_for(material, MaterialId(id as u32)) {
                if is_called_for {
                    let name = || format!("material \"{}\"", material.name);
                    census.add(feature, name, &material.location);
                }
            }
        }
        for instance in &self.geometry.instances {
            let (name, location) = &self.surfaces.models[instance.object as usize];
            census.add(Feature::Instancing, || format!("model \"{}\"", file_name(name)), location);
        }
        census
    }

    /// For each material whether a triangle shows it.
    fn shown_materials(&self) -> Vec<bool> {
        let mut shown = vec![false; self.materials.len()];
        let surfaces = &self.surfaces;
        for mesh in &surfaces.own {
            mesh.materials.iter().for_each(|id| shown[id.index()] = true);
        }
        // The materials of an object count once it is placed with them.
        let mut has_own = vec![false; surfaces.objects.len()];
        for (placed, (material, _)) in self.geometry.instances.iter().zip(&surfaces.instances) {
            let object = placed.object as usize;
            match material {
                Some(id) => shown[id.index()] |= !surfaces.objects[object].is_empty(),
                None => has_own[object] = true,
            }
        }
        for (meshes, _) in surfaces.objects.iter().zip(has_own).filter(|(_, own)| *own) {
            meshes.iter().flat_map(|mesh| &mesh.materials).for_each(|id| shown[id.index()] = true);
        }
        shown
    }

    /// What one material calls for.
    fn called_for(&self, material: &Material, id: MaterialId) -> [(Feature, bool); 10] {
        let lobes = Lobes::of(&material.surface);
        // Textures of the opacity are the hit filter's: part of cut-outs.
        let mut shaded = material.clone();
        let (colors, scalars) = shaded.inputs();
        let has_texture = colors.iter().any(|input| input.texture.is_some())
            || scalars.iter().any(|input| input.texture.is_some());
        [
            (Feature::Emission, self.mean_emission(id).luminance() > 0.0),
            (Feature::Diffuse, lobes.diffuse),
            (Feature::Glossy, lobes.glossy),
            (Feature::Mirror, lobes.mirror),
            (Feature::Refraction, lobes.refraction),
            (Feature::RoughRefraction, lobes.rough_refraction),
            (Feature::Absorption, self.absorption(id).is_some()),
            (Feature::Texture, has_texture),
            (Feature::NormalMap, material.normal.is_some()),
            (Feature::CutOut, material.is_cut_out()),
        ]
    }
}

/// The last part of a path, or all of what is none.
fn file_name(name: &str) -> Cow<'_, str> {
    Path::new(name).file_name().map_or(name.into(), |last| last.to_string_lossy())
}

/// How a surface can scatter, wherever on it; what is doubtful is taken for possible.
#[derive(Default)]
struct Lobes {
    diffuse: bool,
    glossy: bool,
    mirror: bool,
    refraction: bool,
    rough_refraction: bool,
}

impl Lobes {
    fn of(surface: &Surface) -> Self {
        let is_lit = |input: &ColorInput| !input.value.is_black();
        // A texture may make anything of a factor that is not 0: texels can be larger than 1.
        let smooth = |r: &ScalarInput| r.texture.is_some() || Bsdf::is_smooth(r.value);
        let rough = |r: &ScalarInput| match r.texture {
            Some(_) => r.value > 0.0,
            None => !Bsdf::is_smooth(r.value),
        };
        let none = Self::default();
        match surface {
            Surface::Lambert { albedo } | Surface::OrenNayar { albedo, .. } => {
                Self { diffuse: is_lit(albedo), ..none }
            }
            Surface::Mirror { reflectance } => Self { mirror: is_lit(reflectance), ..none },
            Surface::Dielectric { eta, roughness, transmittance, thin, .. } => {
                let transmits = !transmittance.is_black();
                // What hardly refracts is taken for smooth, however rough.
                let mirror = smooth(roughness) || !RoughDielectric::is_refractive(*eta, *thin);
                let glossy = rough(roughness);
                let (refraction, rough_refraction) = (mirror & transmits, glossy & transmits);
                Self { glossy, mirror, refraction, rough_refraction, ..none }
            }
            Surface::Conductor { roughness, .. } => {
                Self { glossy: rough(roughness), mirror: smooth(roughness), ..none }
            }
            Surface::Plastic { albedo, roughness, .. } => Self {
                diffuse: is_lit(albedo),
                glossy: rough(roughness),
                mirror: smooth(roughness),
                ..none
            },
            Surface::Principled {
                base_color,
                metallic,
                roughness,
                specular,
                clearcoat,
                clearcoat_roughness,
                sheen,
                ..
            } => {
                // Even a black metal reflects at grazing angles.
                let is_metal = metallic.value > 0.0;
                let reflects = is_lit(specular) || is_metal;
                let coat = |is_so: bool| *clearcoat > 0.0 && is_so;
                let is_coat_smooth = Bsdf::is_smooth(*clearcoat_roughness);
                Self {
                    // Sheen and what is lost inside a rough metal are as broad as diffuse reflection.
                    diffuse: is_lit(base_color) || *sheen > 0.0 || is_metal && rough(roughness),
                    glossy: reflects && rough(roughness) || coat(!is_coat_smooth),
                    mirror: reflects && smooth(roughness) || coat(is_coat_smooth),
                    ..none
                }
            }
        }
    }
}
