//! What is written is read back.

use super::*;
use crate::polygon::Polygon;
use crate::scene::Surface;
use fredholm::value::{Rgb, Spectrum, Value};
use glam::DVec3;
use npyz::npz::NpzArchive;
use std::io::Cursor;

/// Two surfaces that differ in everything; the name of one would break a careless row.
fn scene() -> Scene<Rgb> {
    let p = |x, y| DVec3::new(x, y, 0.25);
    let surface = |name: &str, reflectance, polygons| Surface {
        name: name.into(),
        reflectance: Spectrum(reflectance),
        emission: Spectrum([0.0, 1.0 / 3.0, 2e-9]),
        polygons,
    };
    let square = Polygon::quadrilateral(p(0.0, 0.0), p(2.0, 0.0), p(2.0, 1.0), p(0.0, 1.0));
    let triangle = Polygon::triangle(p(3.0, 0.0), p(3.0, 1.0), p(4.0, 0.0));
    let surfaces = vec![
        surface("a, \"b\"", [0.1, 0.2, 0.3], vec![square]),
        surface("tür", [0.4, 0.5, 0.6], vec![triangle]),
    ];
    Scene { name: "export".into(), surfaces, lights: Vec::new(), camera: None }
}

/// Writes the scene, cut into 3 patches, with B = (i, i + 1/7, −i) and H = 10 B.
fn written(write: impl Fn(&Field<'_, Rgb>) -> Vec<u8>) -> (Patches<Rgb>, Vec<u8>) {
    let scene = scene();
    let patches = Patches::new(&scene, 1.5).unwrap();
    let radiosity = radiosity(&patches);
    let irradiance: Vec<Rgb> = radiosity.iter().map(|b| *b * 10.0).collect();
    let field = Field::light(&scene, &patches, (&radiosity, &irradiance), Units::Radiometric);
    let bytes = write(&field);
    (patches, bytes)
}

fn radiosity(patches: &Patches<Rgb>) -> Vec<Rgb> {
    (0..patches.len()).map(|i| Spectrum([i as f64, i as f64 + 1.0 / 7.0, -(i as f64)])).collect()
}

/// A row by hand, as the table of the module says.
fn expected_row(patches: &Patches<Rgb>, i: usize) -> Vec<f64> {
    let polygon = &patches.polygons[i];
    let b = radiosity(patches)[i];
    let values = [patches.emission[i], patches.reflectance[i], b, b * 10.0];
    let mut row = polygon.centroid().to_array().to_vec();
    row.extend(polygon.normal().to_array());
    row.push(patches.areas[i]);
    row.extend(values.iter().flat_map(Value::channels));
    row
}

#[test]
fn csv_has_a_header_and_every_number_exactly() {
    let (patches, bytes) = written(|field| {
        let mut bytes = Vec::new();
        write_csv(field, &mut bytes).unwrap();
        bytes
    });
    let text = String::from_utf8(bytes).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(
        lines[0],
        "x,y,z,nx,ny,nz,area,emission_r,emission_g,emission_b,reflectance_r,reflectance_g,reflectance_b,\
         radiosity_r,radiosity_g,radiosity_b,irradiance_r,irradiance_g,irradiance_b,surface"
    );
    assert_eq!((lines.len(), patches.len()), (4, 3));
    for (i, line) in lines[1..].iter().enumerate() {
        let (numbers, name): (Vec<&str>, String) = {
            let mut fields = line.splitn(20, ',').collect::<Vec<_>>();
            let name = fields.pop().unwrap().to_owned();
            (fields, name)
        };
        let numbers: Vec<f64> = numbers.iter().map(|n| n.parse().unwrap()).collect();
        assert_eq!(numbers, expected_row(&patches, i));
        assert_eq!(name, if i < 2 { "\"a, \"\"b\"\"\"" } else { "tür" });
    }
}

#[test]
fn npz_has_every_array_in_its_shape() {
    let (patches, bytes) = written(|field| {
        let mut bytes = Cursor::new(Vec::new());
        write_npz(field, &mut bytes).unwrap();
        bytes.into_inner()
    });
    let mut archive = NpzArchive::new(Cursor::new(bytes)).unwrap();
    let mut matrix = |name: &str, shape: &[u64]| -> Vec<f64> {
        let array = archive.by_name(name).unwrap().unwrap();
        assert_eq!(array.shape(), shape, "{name}");
        array.into_vec().unwrap()
    };
    let arrays: Vec<(Vec<f64>, usize)> = [
        ("centre", 3),
        ("normal", 3),
        ("area", 1),
        ("emission", 3),
        ("reflectance", 3),
        ("radiosity", 3),
        ("irradiance", 3),
    ]
    .map(|(name, columns)| (matrix(name, if columns == 1 { &[3] } else { &[3, 3] }), columns))
    .into();
    for i in 0..3 {
        let row: Vec<f64> =
            arrays.iter().flat_map(|(array, c)| array[i * c..(i + 1) * c].iter().copied()).collect();
        assert_eq!(row, expected_row(&patches, i));
    }
    let surface: Vec<u32> = archive.by_name("surface").unwrap().unwrap().into_vec().unwrap();
    assert_eq!(surface, [0, 0, 1]);
    let names: Vec<String> = archive.by_name("surface_names").unwrap().unwrap().into_vec().unwrap();
    assert_eq!(names, ["a, \"b\"", "tür"]);
}

#[test]
fn vtk_has_a_cell_for_each_patch() {
    use vtkio::model::{Attribute, DataSet, Piece, VertexNumbers, Vtk};
    let (patches, bytes) = written(|field| {
        let mut bytes = Vec::new();
        write_vtu(field, &mut bytes).unwrap();
        bytes
    });
    let vtk = Vtk::parse_xml(Cursor::new(bytes)).unwrap();
    let DataSet::UnstructuredGrid { pieces, .. } = vtk.data else { panic!("another kind of grid") };
    let Piece::Inline(piece) = &pieces[0] else { panic!("a piece elsewhere") };
    let VertexNumbers::XML { offsets, .. } = &piece.cells.cell_verts else { panic!("a legacy file") };
    let ends: Vec<u64> = patches
        .polygons
        .iter()
        .scan(0, |end, polygon| {
            *end += polygon.vertices().len() as u64;
            Some(*end)
        })
        .collect();
    assert_eq!(*offsets, ends);
    let corners: Vec<f64> =
        patches.polygons.iter().flat_map(|p| p.vertices().iter().flat_map(|v| v.to_array())).collect();
    assert_eq!(piece.points.cast_into::<f64>().unwrap(), corners);
    let Attribute::DataArray(array) =
        piece.data.cell.iter().find(|a| a.name() == "radiosity (W/m²)").unwrap()
    else {
        panic!("another kind of attribute")
    };
    let expected: Vec<f64> = radiosity(&patches).iter().flat_map(|b| b.0).collect();
    assert_eq!(array.data.cast_into::<f64>().unwrap(), expected);
}
