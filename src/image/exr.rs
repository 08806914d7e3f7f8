//! OpenEXR files: named channels of 32-bit numbers with metadata, written for users and read back.
//!
//! Files have one part, scan lines, ZIP compression (16 lines a block): the form that every program opens.
//! The same image gives the same bytes, in any process and on any number of threads.

use super::atomic::write_whole;
use super::open::open_regular;
use super::read::{MAX_BYTES, MAX_SIDE, too_large};
use crate::error::{Error, Result};
use exr::block::writer::ParallelBlocksCompressor;
use exr::image::write::layers::{LayersWriter as _, WritableLayers as _};
use exr::meta::attribute::Chromaticities;
use exr::prelude as format;
use exr::prelude::{ReadChannels as _, ReadLayers as _, WritableImage as _};
use std::collections::BTreeMap;
use std::io::{self, BufRead, Read, Seek, SeekFrom, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

/// The first bytes of every EXR file.
pub(super) const MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

/// One value of a file's metadata.
#[derive(Clone, Debug, PartialEq)]
pub enum Attribute {
    /// A text, UTF-8.
    Text(String),
    /// A number.
    Number(f64),
}

/// The numbers of a channel, row-major, top row first.
#[derive(Clone, Debug, PartialEq)]
pub enum Samples {
    /// Measured quantities.
    Float(Vec<f32>),
    /// Identifiers, which a float holds exactly only up to 2^24.
    Uint(Vec<u32>),
}

impl Samples {
    fn len(&self) -> usize {
        match self {
            Self::Float(v) => v.len(),
            Self::Uint(v) => v.len(),
        }
    }
}

/// An image of any number of channels of one size, with metadata.
///
/// Channels are named as programs expect: the picture is `R`, `G`, `B`, `A`, a layer's are `normal.X` and so
/// on. Both maps are in the order of their names, as in the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ExrImage {
    /// Pixels a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Channels by name; each has `width * height` samples.
    pub channels: BTreeMap<String, Samples>,
    /// Attributes by name; names that the format itself defines (`owner`, `comments`, ...) are reserved.
    pub metadata: BTreeMap<String, Attribute>,
}

impl ExrImage {
    /// An image without channels.
    pub fn new(width: u32, height: u32) -> Self {
        Self { width, height, ..Self::default() }
    }

    /// Adds the channels of `layer` (empty for the picture itself) called by the letters of `names`, one
    /// for each number of `pixels`: `add_layer("normal", ["X", "Y", "Z"], ..)`.
    pub fn add_layer<const N: usize>(
        &mut self,
        layer: &str,
        names: [&str; N],
        pixels: impl Iterator<Item = [f32; N]> + Clone,
    ) {
        for (i, name) in names.into_iter().enumerate() {
            let samples = pixels.clone().map(|p| p[i]).collect();
            self.channels.insert(channel_name(layer, name), Samples::Float(samples));
        }
    }

    /// The float channel called `name`.
    pub fn channel(&self, name: &str) -> Option<&[f32]> {
        match self.channels.get(name)? {
            Samples::Float(samples) => Some(samples),
            Samples::Uint(_) => None,
        }
    }
}

fn channel_name(layer: &str, name: &str) -> String {
    if layer.is_empty() { name.to_owned() } else { format!("{layer}.{name}") }
}

/// Writes `image`, with its colours declared linear Rec. 709.
///
/// # Errors
/// When the file cannot be written, a channel has not `width * height` samples, there is no channel, or
/// a name is empty, longer than 255 bytes, or reserved.
pub fn write_exr(path: &Path, image: ExrImage) -> Result<()> {
    let size = (image.width as usize, image.height as usize);
    let complete = image.channels.values().all(|c| c.len() == size.0 * size.1);
    if !complete || image.channels.is_empty() {
        let message = format!("its channels do not make an image of {} x {}", size.0, size.1);
        return Err(Error::image(path, message));
    }

    let channels = image.channels.into_iter().map(|(name, samples)| {
        format::AnyChannel::new(
            text(&name),
            match samples {
                Samples::Float(samples) => format::FlatSamples::F32(samples),
                Samples::Uint(samples) => format::FlatSamples::U32(samples),
            },
        )
    });
    let layer = format::Layer::new(
        size,
        format::LayerAttributes::default(),
        format::Encoding::SMALL_LOSSLESS,
        format::AnyChannels::sort(channels.collect()),
    );
    let mut file = format::Image::from_layer(layer);
    file.attributes.chromaticities = Some(REC_709);
    for (name, value) in &image.metadata {
        let value = match value {
            Attribute::Text(value) => format::AttributeValue::Text(text(value)),
            Attribute::Number(value) => format::AttributeValue::F64(*value),
        };
        file.attributes.other.insert(text(name), value);
    }

    write_whole(path, |out| {
        encode(&file, &mut *out).map_err(|error| match error {
            format::Error::Io(error) => error,
            error => io::Error::other(error.to_string()),
        })?;
        out.flush()?;
        sort_attributes(out.get_mut())
    })
}

/// The one part of a file that is written.
type FlatLayer = format::Layer<format::AnyChannels<format::FlatSamples>>;

/// Compresses on as many threads as the caller's pool has. By itself the crate would take one for each core;
/// on one thread alone a picture with every layer would take seconds longer.
fn encode(file: &format::Image<FlatLayer>, out: impl Write + Seek) -> format::Result<()> {
    let headers = file.write().infer_meta_data();
    let layers = file.layer_data.create_writer(&headers);
    exr::block::write(out, headers, true, |meta, chunks| {
        let blocks = meta.collect_ordered_block_data(|index| {
            layers.extract_uncompressed_block(&meta.headers, index)
        });
        let threads = rayon::current_num_threads();
        let pool = || rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let mut compressor = ParallelBlocksCompressor::new_with_thread_pool(&meta, chunks, pool)
            .ok_or_else(|| io::Error::other("cannot start a thread"))?;
        for (index, block) in blocks {
            compressor.add_block_to_compression_queue(index, block)?;
        }
        Ok(())
    })
}

/// ITU-R BT.709-6, items 1.3 and 1.4.
const REC_709: Chromaticities = Chromaticities {
    red: format::Vec2(0.64, 0.33),
    green: format::Vec2(0.30, 0.60),
    blue: format::Vec2(0.15, 0.06),
    white: format::Vec2(0.3127, 0.3290),
};

/// The format's texts are bytes; programs take them for UTF-8.
fn text(string: &str) -> format::Text {
    format::Text::from_slice_unchecked(string.as_bytes())
}

/// Puts the attributes of a finished single-part file in the order of their names. The crate writes the
/// free ones in the order of a hash map, which differs from run to run.
fn sort_attributes(file: &mut (impl Read + Write + Seek)) -> io::Result<()> {
    const HEADER_START: u64 = 8;
    file.seek(SeekFrom::Start(HEADER_START))?;
    let mut reader = io::BufReader::new(&mut *file);
    let mut attributes = Vec::new();
    loop {
        // name, 0, type, 0, size in 4 bytes, value; an empty name ends the header.
        let mut attribute = Vec::new();
        if reader.read_until(0, &mut attribute)? <= 1 {
            break;
        }
        reader.read_until(0, &mut attribute)?;
        let mut size = [0; 4];
        reader.read_exact(&mut size)?;
        attribute.extend(size);
        reader.by_ref().take(u32::from_le_bytes(size).into()).read_to_end(&mut attribute)?;
        attributes.push(attribute);
    }
    attributes.sort_unstable();
    file.seek(SeekFrom::Start(HEADER_START))?;
    file.write_all(&attributes.concat())
}

/// Reads every channel of an EXR file whose size is that of its first part; channels of further parts are
/// called `part.name`. Half floats become floats, and attributes that are neither texts nor numbers are
/// left out.
///
/// # Errors
/// When the file cannot be read, is damaged, holds deep or subsampled data, or is too large.
pub fn read_exr_channels(path: &Path) -> Result<ExrImage> {
    let file = io::BufReader::new(open_regular(path)?);
    // The decoder of one compression (B44) can overflow on damaged data, which panics where arithmetic is
    // checked. In one thread the panic can be caught; in the crate's thread pool it would abort.
    catch_unwind(AssertUnwindSafe(|| decode(path, file)))
        .unwrap_or_else(|_| Err(damaged(path, "decoding failed")))
}

fn damaged(path: &Path, reason: impl std::fmt::Display) -> Error {
    Error::image(path, format!("{reason}; the EXR file is damaged, write it again"))
}

fn decode(path: &Path, file: impl BufRead + Seek) -> Result<ExrImage> {
    let chunks = exr::block::read(file, false).map_err(|e| damaged(path, e))?;

    // The header says what memory the pixels will take, so it is checked first.
    let mut bytes = 0_u64;
    for header in chunks.headers() {
        let (width, height) = (header.layer_size.0 as u64, header.layer_size.1 as u64);
        if width.max(height) > u64::from(MAX_SIDE) {
            return Err(too_large(path));
        }
        if header.deep {
            return Err(Error::image(path, "deep EXR images cannot be read; flatten it first"));
        }
        bytes = bytes.saturating_add(width * height * header.channels.list.len() as u64 * 4);
        if header.channels.list.iter().any(|c| c.sampling != format::Vec2(1, 1)) {
            let message = "subsampled EXR channels cannot be read; write it again as RGB";
            return Err(Error::image(path, message));
        }
    }
    if bytes > MAX_BYTES {
        return Err(too_large(path));
    }

    let decoded = format::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .all_layers()
        .all_attributes()
        .non_parallel()
        .from_chunks(chunks)
        .map_err(|e| damaged(path, e))?;

    let Some(first) = decoded.layer_data.first() else {
        return Err(damaged(path, "it has no part"));
    };
    let size = first.size;
    let mut image = ExrImage::new(size.0 as u32, size.1 as u32);
    let own = decoded.layer_data.iter().flat_map(|layer| &layer.attributes.other);
    for (name, value) in decoded.attributes.other.iter().chain(own) {
        let value = match value {
            format::AttributeValue::Text(text) => Attribute::Text(string(text)),
            format::AttributeValue::F64(number) => Attribute::Number(*number),
            format::AttributeValue::F32(number) => Attribute::Number(f64::from(*number)),
            format::AttributeValue::I32(number) => Attribute::Number(f64::from(*number)),
            _ => continue,
        };
        image.metadata.insert(string(name), value);
    }
    for (part, layer) in decoded.layer_data.into_iter().enumerate().filter(|(_, l)| l.size == size)
    {
        let part_name = match &layer.attributes.layer_name {
            Some(name) if part > 0 => string(name),
            _ => String::new(),
        };
        for channel in layer.channel_data.list {
            let samples = match channel.sample_data {
                format::FlatSamples::F16(v) => {
                    Samples::Float(v.iter().map(|h| h.to_f32()).collect())
                }
                format::FlatSamples::F32(v) => Samples::Float(v),
                format::FlatSamples::U32(v) => Samples::Uint(v),
            };
            image.channels.insert(channel_name(&part_name, &string(&channel.name)), samples);
        }
    }
    Ok(image)
}

fn string(text: &format::Text) -> String {
    String::from_utf8_lossy(text.as_slice()).into_owned()
}
