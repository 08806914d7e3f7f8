//! Finds Embree, compiles the C shim and generates the bindings; does nothing without feature `embree`.
//!
//! Order: `EMBREE_DIR`, then the system's include folders; Embree 4 before Embree 3. The version's
//! differences stay in `ffi/`; Rust sees one API.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    #[cfg(feature = "embree")]
    embree::build();
}

#[cfg(feature = "embree")]
mod embree {
    use std::env;
    use std::path::{Path, PathBuf};

    struct Installation {
        major: u32,
        include: PathBuf,
        library: Option<PathBuf>,
    }

    pub(crate) fn build() {
        println!("cargo::rerun-if-changed=ffi");
        println!("cargo::rerun-if-env-changed=EMBREE_DIR");
        let Some(found) = find() else {
            println!(
                "cargo::error=Embree was not found. Install it: `apt-get install libembree-dev libclang-dev gcc` \
                 (Debian 12 and 13), or set EMBREE_DIR to its folder, or build without it: \
                 `cargo build --no-default-features --features bvh`."
            );
            return;
        };
        if let Some(library) = &found.library {
            println!("cargo::rustc-link-search=native={}", library.display());
        }
        println!("cargo::rustc-link-lib=dylib=embree{}", found.major);

        let major = found.major.to_string();
        cc::Build::new()
            .file("ffi/embree_shim.c")
            .include("ffi")
            .include(&found.include)
            .define("GLINT_EMBREE_MAJOR", major.as_str())
            .warnings(true)
            .compile("glint_embree_shim");

        let bindings = bindgen::Builder::default()
            .header("ffi/embree_shim.h")
            .clang_arg(format!("-I{}", found.include.display()))
            .clang_arg(format!("-DGLINT_EMBREE_MAJOR={major}"))
            .allowlist_function("rtc(New|Release|Commit)(Device|Scene|Geometry)")
            .allowlist_function(
                "rtcSetShared(GeometryBuffer)|rtcSetScene(Flags|BuildQuality)|rtcAttachGeometryByID",
            )
            .allowlist_function("rtcSetGeometry(InstancedScene|Transform)")
            .allowlist_function(
                "rtc(Get|Set)Device(Error|Property|ErrorFunction|MemoryMonitorFunction)",
            )
            .allowlist_function("glint_.*")
            // An unknown value inside a Rust enum would be undefined behaviour: newtypes instead.
            .default_enum_style(bindgen::EnumVariation::NewType {
                is_bitfield: false,
                is_global: false,
            })
            .bitfield_enum("RTC(SceneFlags|RayQueryFlags|IntersectContextFlags)")
            .prepend_enum_name(false)
            .derive_default(true)
            .generate_comments(false)
            .parse_callbacks(Box::new(bindgen::CargoCallbacks::new()))
            .generate();
        let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
        match bindings {
            Ok(bindings) => {
                bindings.write_to_file(out.join("embree_bindings.rs")).expect("OUT_DIR is writable")
            }
            Err(error) => println!(
                "cargo::error=bindgen could not read the Embree headers ({error}). It needs libclang: \
                 `apt-get install libclang-dev`."
            ),
        }
    }

    fn find() -> Option<Installation> {
        let named = env::var_os("EMBREE_DIR").map(PathBuf::from);
        let roots = named.iter().map(PathBuf::as_path).chain(["/usr/local", "/usr"].map(Path::new));
        for root in roots {
            for major in [4, 3] {
                let include = root.join("include");
                if include.join(format!("embree{major}/rtcore.h")).is_file() {
                    let library = Some(root.join("lib")).filter(|_| root != Path::new("/usr"));
                    return Some(Installation { major, include, library });
                }
            }
        }
        None
    }
}
