//! Scenes of any size: a closed box with boxes in it, a terrain with craters, a building of many rooms.

use fredholm::value::{Rgb, Spectrum};
use glam::DVec3;
use radiosity::polygon::Polygon;
use radiosity::scene::{Scene, Surface};

fn scene(name: &str, surfaces: Vec<Surface<Rgb>>) -> Scene<Rgb> {
    Scene { name: name.into(), surfaces, lights: vec![], camera: None }
}

fn surface(name: &str, reflectance: [f64; 3], emission: f64, polygons: Vec<Polygon>) -> Surface<Rgb> {
    Surface {
        name: name.into(),
        reflectance: Spectrum(reflectance),
        emission: Spectrum([emission; 3]),
        polygons,
    }
}

const WHITE: [f64; 3] = [0.7; 3];
const BLACK: [f64; 3] = [0.0; 3];

/// From corner to corner, seen from the side that `u` × `v` points to.
fn rectangle(corner: DVec3, u: DVec3, v: DVec3) -> Polygon {
    Polygon::quadrilateral(corner, corner + u, corner + u + v, corner + v)
}

/// The six sides of a box, seen from outside.
fn solid(low: DVec3, high: DVec3) -> Vec<Polygon> {
    let size = high - low;
    let [x, y, z] = [DVec3::X * size.x, DVec3::Y * size.y, DVec3::Z * size.z];
    vec![
        rectangle(low, y, x),
        rectangle(low, z, y),
        rectangle(low, x, z),
        rectangle(high, -x, -y),
        rectangle(high, -y, -z),
        rectangle(high, -z, -x),
    ]
}

/// The six sides of a box, seen from within.
fn hollow(low: DVec3, high: DVec3) -> Vec<Polygon> {
    let turned = |polygon: Polygon| {
        let v = polygon.vertices();
        Polygon::quadrilateral(v[3], v[2], v[1], v[0])
    };
    solid(low, high).into_iter().map(turned).collect()
}

/// A hall of 20 m × 20 m × 6 m with 16 boxes on its floor, some on others, and four lamps below its ceiling.
pub fn boxes() -> Scene<Rgb> {
    let hall = hollow(DVec3::ZERO, DVec3::new(20.0, 20.0, 6.0));
    let (mut inside, mut lamps) = (Vec::new(), Vec::new());
    for k in 0..16_u32 {
        let (i, j) = (f64::from(k % 4), f64::from(k / 4));
        let low = DVec3::new(1.5 + 5.0 * i + 0.3 * j, 1.2 + 5.0 * j - 0.2 * i, 0.05);
        let size = DVec3::new(
            1.5 + 0.25 * f64::from(k % 3),
            2.0 - 0.2 * f64::from(k % 5),
            0.8 + 0.2 * f64::from(k % 7),
        );
        inside.extend(solid(low, low + size));
    }
    for (i, j) in [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0)] {
        lamps.push(rectangle(
            DVec3::new(4.0 + 10.0 * i, 4.0 + 10.0 * j, 5.9),
            DVec3::Y * 2.0,
            DVec3::X * 1.0,
        ));
    }
    let parts = vec![
        surface("hall", WHITE, 0.0, hall),
        surface("boxes", [0.6, 0.4, 0.2], 0.0, inside),
        surface("lamps", BLACK, 1000.0, lamps),
    ];
    scene("boxes", parts)
}

/// A square of `count` triangles or somewhat more, 1 km wide, with craters, under a lamp as wide as itself in the south.
pub fn terrain(count: usize) -> Scene<Rgb> {
    let cells = ((count as f64 / 2.0).sqrt().ceil() as usize).max(2);
    let craters: Vec<[f64; 3]> = (0..60_u32)
        .map(|k| {
            let part = |step: f64| (0.5 + step * f64::from(k + 1)).fract();
            [
                1000.0 * part(0.754_877_666),
                1000.0 * part(0.569_840_291),
                20.0 + 100.0 * part(0.618_033_989).powi(4),
            ]
        })
        .collect();
    let height = |x: f64, y: f64| {
        let rolling = 12.0 * (0.011 * x + 0.3).sin() * (0.013 * y).cos()
            + 3.0 * (0.05 * x).cos() * (0.043 * y + 1.0).sin();
        let crater = |[cx, cy, radius]: &[f64; 3]| {
            let r = ((x - cx).powi(2) + (y - cy).powi(2)).sqrt() / radius;
            // A bowl a fifth as deep as wide, with a rim.
            radius * if r < 1.0 { 0.4 * (r * r - 1.0) + 0.08 } else { 0.08 * (-3.0 * (r - 1.0)).exp() }
        };
        rolling + craters.iter().map(crater).sum::<f64>()
    };
    let point = |i: usize, j: usize| {
        let [x, y] = [i, j].map(|k| 1000.0 * k as f64 / cells as f64);
        DVec3::new(x, y, height(x, y))
    };
    let mut ground = Vec::with_capacity(2 * cells * cells);
    for i in 0..cells {
        for j in 0..cells {
            let [a, b, c, d] = [point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)];
            ground.extend([Polygon::triangle(a, b, c), Polygon::triangle(a, c, d)]);
        }
    }
    let lamp = rectangle(
        DVec3::new(0.0, -600.0, 500.0),
        DVec3::new(1000.0, 0.0, 0.0),
        DVec3::new(0.0, 200.0, 400.0),
    );
    let lamp = Polygon::quadrilateral(
        lamp.vertices()[3],
        lamp.vertices()[2],
        lamp.vertices()[1],
        lamp.vertices()[0],
    );
    scene(
        "terrain",
        vec![surface("ground", [0.4, 0.35, 0.3], 0.0, ground), surface("lamp", BLACK, 1000.0, vec![lamp])],
    )
}

/// Storeys of `side` × `side` rooms of 5 m × 5 m × 3 m with a lamp each, open to their neighbours by doors in walls of 20 cm, and to those
/// above and below by a stairwell in the middle, without floors and lamps.
pub fn building(side: usize, storeys: usize) -> Scene<Rgb> {
    const ROOM: f64 = 5.0;
    const HEIGHT: f64 = 3.0;
    const WALL: f64 = 0.2;
    const DOOR: f64 = 1.0;
    const TOP: f64 = 2.1;
    let (mut walls, mut lamps) = (Vec::new(), Vec::new());
    let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
    for k in 0..side * side * storeys {
        let (cell, storey) = ([k % side, k / side % side], k / (side * side));
        let low = DVec3::new(cell[0] as f64, cell[1] as f64, 0.0) * (ROOM + WALL)
            + storey as f64 * (HEIGHT + WALL) * z;
        let high = low + DVec3::new(ROOM, ROOM, HEIGHT);
        let is_stairs = cell == [side / 2; 2];
        if storey == 0 || !is_stairs {
            walls.push(rectangle(low, x * ROOM, y * ROOM));
        }
        if storey + 1 == storeys || !is_stairs {
            walls.push(rectangle(low + z * HEIGHT, y * ROOM, x * ROOM));
            lamps.push(rectangle(low + DVec3::new(2.0, 2.0, HEIGHT - 0.05), y * 1.0, x * 1.0));
        } else {
            let edges = hollow(low + z * HEIGHT, high + z * WALL);
            walls.extend(edges.into_iter().filter(|edge| edge.normal().dot(z).abs() < 0.5));
        }
        // Each wall from its corner along `u`, seen from the side of `inwards`.
        let mut wall = |corner: DVec3, u: DVec3, door: bool| {
            if !door {
                walls.push(rectangle(corner, u * ROOM, z * HEIGHT));
                return;
            }
            let [from, to] = [0.5 * (ROOM - DOOR), 0.5 * (ROOM + DOOR)];
            walls.push(rectangle(corner, u * from, z * HEIGHT));
            walls.push(rectangle(corner + u * to, u * (ROOM - to), z * HEIGHT));
            walls.push(rectangle(corner + u * from + z * TOP, u * DOOR, z * (HEIGHT - TOP)));
        };
        wall(low + x * ROOM, -x, cell[1] > 0);
        wall(low, y, cell[0] > 0);
        wall(high - z * HEIGHT, -y, cell[0] + 1 < side);
        wall(low + y * ROOM, x, cell[1] + 1 < side);
        // The doorways to the neighbours with larger numbers.
        for (axis, along) in [(0, x), (1, y)] {
            if cell[axis] + 1 < side {
                let across = if axis == 0 { y } else { x };
                let start = low + along * ROOM + across * (0.5 * (ROOM - DOOR));
                let sides = hollow(start, start + along * WALL + across * DOOR + z * TOP);
                walls.extend(sides.into_iter().filter(|side| side.normal().dot(along).abs() < 0.5));
            }
        }
    }
    scene("building", vec![surface("walls", WHITE, 0.0, walls), surface("lamps", BLACK, 1000.0, lamps)])
}
