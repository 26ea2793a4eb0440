// The parts of three.js that the page uses. `./update` bundles them to three.js.
export {
  AmbientLight, BoxGeometry, BufferAttribute, BufferGeometry, CapsuleGeometry, CircleGeometry, Color, ConeGeometry,
  CylinderGeometry, DirectionalLight, DoubleSide, EdgesGeometry, Group, HemisphereLight, LineBasicMaterial,
  LineSegments, Matrix3, Matrix4, Mesh, MeshLambertMaterial, PCFShadowMap, PerspectiveCamera, Quaternion, Scene,
  ShadowMaterial, SphereGeometry, Vector3, WebGLRenderer,
} from "three";
export { OrbitControls } from "three/addons/controls/OrbitControls.js";
export { mergeGeometries } from "three/addons/utils/BufferGeometryUtils.js";
