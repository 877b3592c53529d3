// What the page uses of three.js.
export {
  Box3, BufferGeometry, Color, ConeGeometry, BufferAttribute, DataTexture, DoubleSide, FloatType,
  GLSL3, Group, LineBasicMaterial, LineSegments, Matrix4, Mesh, MeshBasicMaterial,
  OrthographicCamera, RGBAFormat, RawShaderMaterial, Scene, Sphere, UnsignedByteType, Vector2,
  Vector3, WebGLRenderer,
} from "three";
export { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
