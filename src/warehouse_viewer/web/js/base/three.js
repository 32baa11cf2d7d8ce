// SPDX-License-Identifier: Apache-2.0
// What the page takes of three.js, as the module that its own modules import: the server serves this
// file as /three/build/three.module.js, and index.html loads three.min.js before, which is half as large.

export const {
  AlwaysDepth, Box3, BoxBufferGeometry, BufferAttribute, BufferGeometry, CanvasTexture, Color, CubeTexture, CylinderBufferGeometry, DataTexture,
  DepthTexture, DirectionalLight, DoubleSide, DynamicDrawUsage, EventDispatcher, ExtrudeBufferGeometry, Float32BufferAttribute, FloatType, Fog, Frustum, Group,
  HemisphereLight, InstancedBufferAttribute, InstancedBufferGeometry, InstancedInterleavedBuffer, InstancedMesh, InterleavedBufferAttribute, LineBasicMaterial, LineSegments, LinearFilter,
  LinearMipMapLinearFilter, LinearMipMapNearestFilter, MOUSE, Matrix4, Mesh, MeshBasicMaterial, MeshLambertMaterial, MeshStandardMaterial, Object3D,
  OrthographicCamera, PCFSoftShadowMap, Path, PerspectiveCamera, Plane, PlaneBufferGeometry, Quaternion, RGBAFormat, Raycaster, RepeatWrapping,
  RingBufferGeometry, Scene, ShaderMaterial, ShadowMaterial, Shape, ShapeBufferGeometry, SphereBufferGeometry, Spherical, TOUCH, Vector2,
  Vector3, VertexColors, WebGLRenderTarget, WebGLRenderer,
} = window.THREE;
