//! `Mesh(model: "models/vase.obj")`: an indexed triangle mesh from a file; instances share its data and its tree.
//!
//! `shading: AsModelled` smooths the triangles whose corners have normals in the file; `Flat` smooths none; `Smooth`
//! smooths all, with the area-weighted mean normal of the faces around each vertex where the file has none.

use super::{mesh_methods::OtherTrees, mesh_surface::MetMesh, mesh_tree::MeshTree, shear::RayFrame, terminator};
use crate::{
    asset::Asset,
    choice,
    describe::Describe,
    lanes,
    method::Methods,
    packet::{Hits, Mask, Packet, PerRay},
    primitive::{Cost, Degenerate, Extent, Hit, Primitive, Surface},
    space::{BoundingSphere, Bounds, Ray},
    surfaces::{Meeting, Surfaces},
};
use bevy_ecs::prelude::*;
use glam::{DAffine3, DMat3, DVec2, DVec3};
use std::sync::{Arc, OnceLock};

/// Index of a normal or texture coordinate that a corner does not have.
const ABSENT: u32 = u32::MAX;

/// Normals or texture coordinates, by triangle corner.
#[derive(Clone, Debug, Default, PartialEq)]
struct Attribute<const N: usize> {
    values: Vec<[f32; N]>,
    /// Per triangle; [`ABSENT`] in the first where a triangle has none. Empty if no triangle has any.
    corners: Vec<[u32; 3]>,
}

impl<const N: usize> Attribute<N> {
    /// Whether all of so many triangles have it.
    fn is_complete(&self, triangles: usize) -> bool {
        self.corners.len() == triangles && self.corners.iter().all(|corners| corners[0] != ABSENT)
    }

    #[inline]
    fn of(&self, triangle: u32) -> Option<[[f32; N]; 3]> {
        let [a, b, c] = *self.corners.get(triangle as usize).filter(|corners| corners[0] != ABSENT)?;
        Some([self.values[a as usize], self.values[b as usize], self.values[c as usize]])
    }
}

/// The triangles of a mesh, immutable, in object space.
///
/// Vertices are kept as `f32`, as files hold them; every computation with them is in `f64`.
#[derive(Debug, Default)]
pub struct TriangleMesh {
    positions: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
    normals: Attribute<3>,
    uvs: Attribute<2>,
    slots: Vec<u16>,
    degenerate: usize,
    tree: OnceLock<Arc<MeshTree>>,
    pub(super) others: OtherTrees,
    smooth_normals: OnceLock<Vec<[f32; 3]>>,
}

/// Why a mesh cannot be made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MeshError(String);

impl MeshError {
    /// An error with its reason.
    #[must_use]
    pub fn new(reason: impl Into<String>) -> Self {
        Self(reason.into())
    }
}

impl core::fmt::Display for MeshError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(&self.0)
    }
}

impl core::error::Error for MeshError {}

impl TriangleMesh {
    /// A mesh of triangles given by their corners' indices, counter-clockwise seen from outside.
    ///
    /// Triangles without area are dropped and counted.
    ///
    /// # Errors
    /// An index beyond the positions, or a position of a triangle that is not finite.
    pub fn new(positions: Vec<[f32; 3]>, triangles: Vec<[u32; 3]>) -> Result<Self, MeshError> {
        check_indices("triangle", &triangles, positions.len())?;
        for (i, triangle) in triangles.iter().enumerate() {
            if let Some(v) = triangle.iter().find(|&&v| !positions[v as usize].iter().all(|x| x.is_finite())) {
                return Err(MeshError(format!("triangle {i}: vertex {v} is not finite: {:?}", positions[*v as usize])));
            }
        }
        let mut this = Self { positions, triangles, ..Self::default() };
        this.degenerate = this.triangles.len();
        let all = core::mem::take(&mut this.triangles);
        this.triangles = all.into_iter().filter(|t| this.cross(*t) != DVec3::ZERO).collect();
        this.degenerate -= this.triangles.len();
        Ok(this)
    }

    /// The mesh with normals, textures coordinates and material slots per corner or triangle.
    ///
    /// Each list of corners has one entry per triangle given to [`TriangleMesh::new`] here; `None` for a triangle
    /// without. A slot is an index into the materials of whoever shows the mesh. Triangles without area are dropped and
    /// counted.
    ///
    /// # Errors
    /// An index out of range, lists of other lengths than `triangles`, or a position, normal or coordinate of a
    /// triangle that is not finite.
    pub fn with_attributes(
        positions: Vec<[f32; 3]>,
        triangles: Vec<[u32; 3]>,
        normals: (Vec<[f32; 3]>, Vec<Option<[u32; 3]>>),
        uvs: (Vec<[f32; 2]>, Vec<Option<[u32; 3]>>),
        slots: Vec<u16>,
    ) -> Result<Self, MeshError> {
        let count = triangles.len();
        for (what, len) in [("normals", normals.1.len()), ("uvs", uvs.1.len()), ("slots", slots.len())] {
            if len != 0 && len != count {
                return Err(MeshError(format!("{what}: {len} entries for {count} triangles")));
            }
        }
        let normals = attribute("normal", normals)?;
        let uvs = attribute("texture coordinate", uvs)?;
        let all = triangles.clone();
        let mut this = Self::new(positions, triangles)?;
        let kept: Vec<usize> = (0..count).filter(|&i| this.cross(all[i]) != DVec3::ZERO).collect();
        let keep = |corners: Vec<[u32; 3]>| {
            if corners.is_empty() { corners } else { kept.iter().map(|&i| corners[i]).collect() }
        };
        this.normals = Attribute { values: normals.values, corners: keep(normals.corners) };
        this.uvs = Attribute { values: uvs.values, corners: keep(uvs.corners) };
        if !slots.is_empty() {
            this.slots = kept.iter().map(|&i| slots[i]).collect();
        }
        Ok(this)
    }

    /// Count of triangles that have an area.
    #[must_use]
    pub fn len(&self) -> usize {
        self.triangles.len()
    }

    /// Whether there is no triangle.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// Count of triangles dropped for having no area.
    #[must_use]
    pub fn degenerate(&self) -> usize {
        self.degenerate
    }

    /// Corners of a triangle, object space.
    ///
    /// # Panics
    /// If there is no such triangle.
    #[must_use]
    #[inline]
    pub fn corners(&self, triangle: usize) -> [DVec3; 3] {
        match self.tree.get() {
            // Where a search has just read them, if one has.
            Some(tree) => tree.vertices(triangle as u32),
            None => self.points(self.triangles[triangle]),
        }
    }

    /// Bytes of the mesh and its tree, if that was built.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let corners = self.triangles.len() + self.normals.corners.len() + self.uvs.corners.len();
        let tree = self.tree.get().map_or(0, |tree| tree.bytes());
        let values = (self.positions.len() + self.normals.values.len()) * 12 + self.uvs.values.len() * 8;
        values + corners * 12 + self.slots.len() * 2 + tree
    }

    /// Texture coordinates at a triangle's corners, if it has any.
    #[inline]
    pub(super) fn uvs_of(&self, triangle: u32) -> Option<[[f32; 2]; 3]> {
        self.uvs.of(triangle)
    }

    #[inline]
    fn points(&self, corners: [u32; 3]) -> [DVec3; 3] {
        corners.map(|i| point(self.positions[i as usize]))
    }

    /// Twice the area as a vector along the outward normal; exact zero only without area.
    fn cross(&self, corners: [u32; 3]) -> DVec3 {
        let [a, b, c] = self.points(corners);
        (b - a).cross(c - a)
    }

    fn tree(&self) -> &Arc<MeshTree> {
        self.tree.get_or_init(|| {
            let corners = |i: u32| {
                let [a, b, c] = self.triangles[i as usize];
                [self.positions[a as usize], self.positions[b as usize], self.positions[c as usize]]
            };
            Arc::new(MeshTree::build(self.len(), corners))
        })
    }

    /// Area-weighted mean of the face normals around each vertex; zero where they cancel.
    fn smooth_normals(&self) -> &[[f32; 3]] {
        self.smooth_normals.get_or_init(|| {
            let mut sums = vec![DVec3::ZERO; self.positions.len()];
            for &triangle in &self.triangles {
                let cross = self.cross(triangle);
                for v in triangle {
                    sums[v as usize] += cross;
                }
            }
            sums.into_iter().map(|sum| sum.normalize_or_zero().as_vec3().to_array()).collect()
        })
    }
}

#[inline]
pub(super) fn point([x, y, z]: [f32; 3]) -> DVec3 {
    DVec3::new(f64::from(x), f64::from(y), f64::from(z))
}

#[inline]
pub(super) fn point2([x, y]: [f32; 2]) -> DVec2 {
    DVec2::new(f64::from(x), f64::from(y))
}

fn check_indices(what: &str, corners: &[[u32; 3]], len: usize) -> Result<(), MeshError> {
    let beyond = |corners: &[u32; 3]| corners.iter().copied().find(|&i| i as usize >= len);
    match corners.iter().enumerate().find_map(|(i, c)| beyond(c).map(|index| (i, index))) {
        Some((i, index)) => Err(MeshError(format!("{what} {i}: index {index} of {len}"))),
        None => Ok(()),
    }
}

fn attribute<const N: usize>(
    what: &str,
    (values, corners): (Vec<[f32; N]>, Vec<Option<[u32; 3]>>),
) -> Result<Attribute<N>, MeshError> {
    if corners.iter().all(Option::is_none) {
        return Ok(Attribute { values: vec![], corners: vec![] });
    }
    let given: Vec<[u32; 3]> = corners.iter().copied().flatten().collect();
    check_indices(what, &given, values.len())?;
    if let Some(i) = given.iter().flatten().find(|&&i| !values[i as usize].iter().all(|x| x.is_finite())) {
        return Err(MeshError(format!("{what} {i} is not finite")));
    }
    Ok(Attribute { values, corners: corners.into_iter().map(|c| c.unwrap_or([ABSENT; 3])).collect() })
}

choice! {
    /// Which triangles of a mesh are smoothed.
    pub enum Shading {
        /// Those whose corners have normals in the file.
        #[default]
        AsModelled,
        /// None.
        Flat,
        /// All; where the file has no normals, by the mean of the faces around each vertex.
        Smooth,
    }
}

/// A triangle mesh from a file.
#[derive(Component, Clone, Debug, Default, Describe)]
pub struct Mesh {
    /// OBJ file, relative to the scene's.
    #[describe(required)]
    pub model: Asset<TriangleMesh>,
    /// Which triangles are smoothed.
    pub shading: Shading,
}

impl Mesh {
    /// A mesh made in memory, shaded as modelled.
    #[must_use]
    pub fn new(model: impl Into<Arc<TriangleMesh>>) -> Self {
        Self { model: Asset::from_data(model), shading: Shading::AsModelled }
    }

    /// The same mesh with every triangle smoothed.
    #[must_use]
    pub fn smooth(self) -> Self {
        Self { shading: Shading::Smooth, ..self }
    }
}

/// A placed mesh as the inner loop sees it.
#[derive(Clone, Debug)]
pub struct PackedMesh {
    placed: Arc<Placed>,
}

/// What [`PackedMesh`] points to.
#[derive(Debug)]
pub(super) struct Placed {
    pub(super) tree: Arc<MeshTree>,
    pub(super) mesh: Arc<TriangleMesh>,
    shading: Shading,
    pub(super) object_from_world: DAffine3,
    pub(super) world_from_object: DAffine3,
    /// Turns normals, but for their lengths.
    pub(super) cotangent: DMat3,
    /// Of a point of the surface, world units.
    pub(super) error: f64,
}

impl Placed {
    /// The normals at a triangle's vertices, object space, if it is smoothed; of any length.
    #[inline]
    pub(super) fn normals(&self, triangle: u32) -> Option<[[f32; 3]; 3]> {
        let mesh = &*self.mesh;
        let modelled = || mesh.normals.of(triangle);
        match self.shading {
            Shading::Flat => None,
            Shading::AsModelled => modelled(),
            Shading::Smooth => modelled().or_else(|| {
                let [a, b, c] = mesh.triangles[triangle as usize];
                let normals = mesh.smooth_normals();
                Some([normals[a as usize], normals[b as usize], normals[c as usize]])
            }),
        }
    }

    /// The slot of a triangle's material.
    #[inline]
    pub(super) fn slot_of(&self, triangle: u32) -> u32 {
        self.mesh.slots.get(triangle as usize).map_or(0, |&slot| u32::from(slot))
    }

    /// See [`Primitive::lift`].
    fn lift(&self, ray: &Ray, hit: Hit) -> DVec3 {
        let Some(normals) = self.normals(hit.part) else { return DVec3::ZERO };
        let vertices = self.tree.vertices(hit.part);
        let weights = RayFrame::new(&ray.transformed(&self.object_from_world)).weights(vertices);
        let [a, b, c] = vertices;
        let normal = self.cotangent * (b - a).cross(c - a);
        let side = if normal.dot(ray.direction) < 0.0 { 1.0 } else { -1.0 };
        let vertices = vertices.map(|v| self.world_from_object.transform_point3(v));
        let normals = normals.map(|n| (self.cotangent * point(n)).normalize_or_zero() * side);
        terminator::lift(vertices, normals, weights)
    }

    /// The surface at a hit without texture coordinates, and the weights of the triangle's vertices there.
    #[inline]
    fn surface(&self, ray: &Ray, hit: Hit) -> (Surface, [f64; 3]) {
        let vertices = self.tree.vertices(hit.part);
        let [a, b, c] = vertices;
        let [u, v, w] = RayFrame::new(&ray.transformed(&self.object_from_world)).weights(vertices);
        let blend = |[a, b, c]: [DVec3; 3]| a * u + b * v + c * w;
        let normal = (self.cotangent * (b - a).cross(c - a)).normalize_or(DVec3::Y);
        let blended = self.normals(hit.part).map(|[a, b, c]| blend([point(a), point(b), point(c)]));
        let surface = Surface {
            point: self.world_from_object.transform_point3(blend(vertices)),
            normal,
            shading_normal: blended.map_or(normal, |blended| (self.cotangent * blended).normalize_or(normal)),
            uv: DVec2::ZERO,
            slot: self.slot_of(hit.part),
            error: self.error,
        };
        (surface, [u, v, w])
    }
}

impl PackedMesh {
    /// A mesh placed by `world_from_object`.
    ///
    /// # Errors
    /// The mesh has no triangle.
    pub(crate) fn place(
        mesh: Arc<TriangleMesh>,
        shading: Shading,
        world_from_object: &DAffine3,
    ) -> Result<(Extent, Self), Degenerate> {
        if mesh.is_empty() {
            return Err(Degenerate("its model has no triangles with an area".into()));
        }
        let tree = mesh.tree();
        if shading == Shading::Smooth && !mesh.normals.is_complete(mesh.len()) {
            // Now, not while rays wait for the first of them.
            mesh.smooth_normals();
        }
        let bounds = tree.top_boxes().map(|b| b.transformed(world_from_object)).reduce(Bounds::union);
        let object_from_world = world_from_object.inverse();
        let reach = tree.magnitude * norm(&world_from_object.matrix3);
        let reach = reach + world_from_object.translation.abs().max_element();
        let placed = Placed {
            tree: tree.clone(),
            mesh: mesh.clone(),
            shading,
            object_from_world,
            world_from_object: *world_from_object,
            cotangent: object_from_world.matrix3.transpose(),
            error: Surface::rounding(reach),
        };
        Ok((Extent::Bounded(bounds.unwrap_or(Bounds::EMPTY)), Self { placed: Arc::new(placed) }))
    }
}

impl Primitive for Mesh {
    type Packed = PackedMesh;

    fn pack(&self, world_from_object: &DAffine3) -> Result<(Extent, PackedMesh), Degenerate> {
        let mesh = self.model.data.clone().ok_or_else(|| Degenerate("its model was not loaded".into()))?;
        PackedMesh::place(mesh, self.shading, world_from_object)
    }

    #[inline]
    fn hit(packed: &PackedMesh, ray: &Ray, t_max: f64, cost: &mut Cost) -> Option<Hit> {
        let placed = &*packed.placed;
        placed.tree.nearest(&placed.object_from_world, ray, t_max, cost)
    }

    fn hit_with(packed: &PackedMesh, ray: &Ray, t_max: f64, with: &Methods, cost: &mut Cost) -> Option<Hit> {
        let ray = ray.transformed(&packed.placed.object_from_world);
        packed.placed.mesh.hit_with(&ray, t_max, with, cost)
    }

    #[inline]
    fn blocks(packed: &PackedMesh, ray: &Ray, t_max: f64, cost: &mut Cost) -> bool {
        let placed = &*packed.placed;
        placed.tree.blocks(&placed.object_from_world, ray, t_max, cost)
    }

    fn blocks_with(packed: &PackedMesh, ray: &Ray, t_max: f64, with: &Methods, cost: &mut Cost) -> bool {
        let ray = ray.transformed(&packed.placed.object_from_world);
        packed.placed.mesh.blocks_with(&ray, t_max, with, cost)
    }

    fn hit_packet(
        packed: &PackedMesh,
        packet: &Packet,
        rays: Mask,
        t_max: &PerRay,
        hits: &mut Hits,
        cost: &mut Cost,
    ) -> Mask {
        let placed = &*packed.placed;
        placed.tree.nearest_packet(&placed.object_from_world, packet, rays, t_max, hits, cost)
    }

    fn blocks_packet(packed: &PackedMesh, packet: &Packet, rays: Mask, t_max: &PerRay, cost: &mut Cost) -> Mask {
        let placed = &*packed.placed;
        placed.tree.blocks_packet(&placed.object_from_world, packet, rays, t_max, cost)
    }

    #[inline]
    fn surface(packed: &PackedMesh, ray: &Ray, hit: Hit) -> Surface {
        let (surface, [u, v, w]) = packed.placed.surface(ray, hit);
        let uv = match packed.placed.mesh.uvs_of(hit.part) {
            Some([a, b, c]) => point2(a) * u + point2(b) * v + point2(c) * w,
            None => DVec2::new(v, w),
        };
        Surface { uv, ..surface }
    }

    #[inline]
    fn surface_without_uv(packed: &PackedMesh, ray: &Ray, hit: Hit) -> Surface {
        packed.placed.surface(ray, hit).0
    }

    fn lift(packed: &PackedMesh, ray: &Ray, hit: Hit) -> DVec3 {
        packed.placed.lift(ray, hit)
    }

    fn surface_packet(meshes: &[PackedMesh], met: &Meeting<'_>, surfaces: &mut Surfaces) {
        let mut rest = met.rays;
        while rest != 0 {
            let mesh = met.shape[rest.trailing_zeros() as usize];
            let rays = rest & met.with(mesh);
            rest &= !rays;
            lanes::run(MetMesh { placed: &meshes[mesh as usize].placed, met, rays, surfaces });
        }
    }

    fn bounding_sphere(packed: &PackedMesh, _: &Bounds) -> BoundingSphere {
        let (sphere, to) = (packed.placed.tree.sphere, packed.placed.world_from_object);
        let center = to.transform_point3(sphere.center);
        BoundingSphere::about(center, [center + DVec3::X * (sphere.radius * norm(&to.matrix3))])
    }
}

/// An upper bound of how much a matrix lengthens any vector; exact for uniform scales up to rounding.
fn norm(m: &DMat3) -> f64 {
    let gram = m.transpose() * *m;
    let rows = gram.x_axis.abs() + gram.y_axis.abs() + gram.z_axis.abs();
    rows.max_element().sqrt() * (1.0 + 8.0 * f64::EPSILON)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quad() -> TriangleMesh {
        let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [f32::NAN; 3]];
        TriangleMesh::new(positions, vec![[0, 1, 2], [0, 0, 1], [0, 2, 3]]).expect("a mesh")
    }

    #[test]
    fn triangles_without_area_are_counted_and_unused_vertices_ignored() {
        let mesh = quad();
        assert_eq!((mesh.len(), mesh.degenerate()), (2, 1));
        let (extent, _) = Mesh::new(mesh).pack(&DAffine3::IDENTITY).expect("packed");
        assert!(matches!(extent, Extent::Bounded(b) if b.min.is_finite() && b.contains(DVec3::new(1.0, 1.0, 0.0))));
    }

    #[test]
    fn an_edge_hit_goes_to_the_lowest_triangle_and_is_blocked_too() {
        let (_, packed) = Mesh::new(quad()).pack(&DAffine3::IDENTITY).expect("packed");
        let ray = Ray { origin: DVec3::new(0.5, 0.5, 2.0), direction: DVec3::NEG_Z };
        let hit = Mesh::hit(&packed, &ray, f64::INFINITY, &mut Cost::default());
        assert_eq!(hit, Some(Hit { t: 2.0, part: 0 }));
        assert!(Mesh::blocks(&packed, &ray, 2.5, &mut Cost::default()));
        assert!(!Mesh::blocks(&packed, &ray, 2.0, &mut Cost::default()));
    }

    #[test]
    fn faults_name_the_triangle() {
        let positions = vec![[0.0; 3], [1.0, 0.0, 0.0]];
        let error = TriangleMesh::new(positions, vec![[0, 1, 2]]).expect_err("an index beyond");
        assert_eq!(error.to_string(), "triangle 0: index 2 of 2");
        let error = TriangleMesh::new(vec![[f32::INFINITY; 3]; 3], vec![[0, 1, 2]]).expect_err("not finite");
        assert!(error.to_string().contains("vertex 0 is not finite"));
    }

    #[test]
    fn smooth_shading_blends_the_faces_around_a_vertex() {
        let roof = vec![[0.0, 1.0, 0.0], [0.0, 1.0, 1.0], [1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]];
        let mesh = TriangleMesh::new(roof, vec![[0, 1, 2], [1, 0, 3]]).expect("a mesh");
        let (_, packed) = Mesh::new(mesh).smooth().pack(&DAffine3::IDENTITY).expect("packed");
        let ray = Ray { origin: DVec3::new(0.0, 5.0, 0.25), direction: DVec3::NEG_Y };
        let hit = Mesh::hit(&packed, &ray, f64::INFINITY, &mut Cost::default()).expect("the ridge");
        assert!((Mesh::surface(&packed, &ray, hit).shading_normal - DVec3::Y).length() < 1e-6);
    }
}
