// Scenes that break one rule each: the changes of kPlainScene, and the expected problem.
#pragma once

#include <ostream>
#include <string>
#include <vector>

namespace sprung {

struct BrokenScene {
  std::string name;
  std::vector<std::string> changes;   ///< as --set
  std::string key;                    ///< of the problem
  std::string message;                ///< contained in the line of the problem
  bool schema_expresses_rule = true;  ///< whether a JSON Schema can express the rule
};

inline std::ostream& operator<<(std::ostream& stream, const BrokenScene& scene) { return stream << scene.name; }

// clang-format off
inline const std::vector<BrokenScene>& broken_scenes() {
  static const std::vector<BrokenScene> kScenes{
      {"UnknownKeyOfTheScene", {"duraton=1"}, "duraton", "is not a known key; did you mean \"duration\"?"},
      {"UnknownKeyOfASpring", {"bodies.banner.springs.structural.stifness=1"}, "bodies.banner.springs.structural.stifness", "did you mean \"stiffness\"?"},
      {"SpringDampedTwice", {"bodies.banner.springs.shear={\"stiffness\":1,\"damping\":0.1,\"damping_ratio\":0.1}"}, "bodies.banner.springs.shear", "may have only one of damping, damping_ratio"},
      {"NegativeDampingRatio", {"bodies.banner.springs.shear={\"modulus\":1,\"damping_ratio\":-0.1}"}, "bodies.banner.springs.shear.damping_ratio", "must be at least 0"},
      {"DampingRatioWithoutStiffness", {"bodies.banner.springs.shear={\"stiffness\":0,\"damping_ratio\":0.1}"}, "bodies.banner.springs.shear.damping_ratio", "needs springs with stiffness; give damping instead", false},
      {"UnknownBendModel", {"bodies.banner.springs.bend={\"modulus\":1,\"model\":\"angel\"}"}, "bodies.banner.springs.bend.model", "must be one of spring, angle; did you mean \"angle\"?"},
      {"ModelOfStructuralSprings", {"bodies.banner.springs.structural={\"modulus\":1,\"model\":\"angle\"}"}, "bodies.banner.springs.structural.model", "is not a known key"},
      {"UnknownKeyOfAPin", {"bodies.banner.pins[0].wich=[]"}, "bodies.banner.pins[0].wich", "did you mean \"which\"?"},
      {"UnknownKeyLikeNoOther", {"bodies.banner.colour=red"}, "bodies.banner.colour", "choose from shape, mass"},
      {"SolverOfALaterVersion", {"solver.type=xpbd"}, "solver", "is not a known key"},
      {"SelfContactIsANumber", {"bodies.banner.self_contact=1"}, "bodies.banner.self_contact", "must be true or false"},
      {"BodyContactIsText", {"bodies.banner.body_contact=\"off\""}, "bodies.banner.body_contact", "must be true or false"},
      {"SelfContactByPenalty", {"bodies.banner.self_contact=true", "contact={\"response\":\"penalty\",\"stiffness\":1,\"damping\":1}"}, "bodies.banner.self_contact", "needs contact.response \"projection\"", false},
      {"EmptySchema", {"$schema=\"\""}, "$schema", "must not be empty"},
      {"MissingDuration", {"duration=null"}, "duration", "is missing; it is required"},
      {"MissingBodies", {"bodies=null"}, "bodies", "is missing"},
      {"NoBodies", {"bodies={}"}, "bodies", "must have at least one entry"},
      {"MissingShape", {"bodies.banner.shape=null"}, "bodies.banner.shape", "is missing"},
      {"MissingShapeType", {"bodies.banner.shape.type=null"}, "bodies.banner.shape.type", "is missing"},
      {"WrongVersion", {"version=2"}, "version", "= 2: must be 1"},
      {"NegativeDuration", {"duration=-1"}, "duration", "duration = -1: must be at least 0"},
      {"TooManyFrames", {"duration=1e20"}, "duration", "frames", false},
      {"DurationIsText", {"duration=\"long\""}, "duration", "duration = \"long\": must be a number"},
      {"FrameRateOfZero", {"frame_rate=0"}, "frame_rate", "must be greater than 0"},
      {"FrameRateIsABoolean", {"frame_rate=true"}, "frame_rate", "must be a number"},
      {"NegativeStep", {"step=-0.001"}, "step", "must be greater than 0"},
      {"StepOfZero", {"step=0"}, "step", "must be greater than 0"},
      {"StepIsAWord", {"step=automatic"}, "step", "must be a number of seconds, or \"auto\""},
      {"StepDoesNotDivideTheFrame", {"frame_rate=25", "step=0.003"}, "step", "not a whole number; use 0.003076923076923077 or 0.002857142857142857, or \"auto\"", false},
      {"StepLongerThanAFrame", {"frame_rate=50", "step=0.03"}, "step", "not a whole number; use 0.02, or \"auto\"", false},
      {"StepTooShort", {"step=1e-29"}, "step", "use a larger step", false},
      {"GravityIsANumber", {"gravity=-9.81"}, "gravity", "must be a list of 3 entries, written in [ ]"},
      {"GravityOfTwoNumbers", {"gravity=[0,-9.81]"}, "gravity", "must have 3 entries; it has 2"},
      {"GravityContainsText", {"gravity=[0,\"down\",0]"}, "gravity[1]", "must be a number"},
      {"HugeNumber", {"gravity=[0,-1e300,0]"}, "gravity[1]", "must be at most 1e+30 in magnitude"},
      {"NegativeDrag", {"air.drag=-1"}, "air.drag", "must be at least 0"},
      {"AirIsANumber", {"air=1"}, "air", "must be an object"},
      {"UnknownIntegrator", {"integrator.type=verlett"}, "integrator.type", "did you mean \"verlet\"?"},
      {"DampingOfEuler", {"integrator={\"type\":\"explicit_euler\",\"damping\":0.1}"}, "integrator.damping", "is not a known key; only the integrator verlet has it: remove it"},
      {"DampingOfVelocityVerlet", {"integrator={\"type\":\"velocity_verlet\",\"damping_rate\":0.1}"}, "integrator.damping_rate", "is not a known key"},
      {"StartAtRestOfRungeKutta", {"integrator={\"type\":\"rk4\",\"start_at_rest\":true}"}, "integrator.start_at_rest", "is not a known key"},
      {"DampingOfImplicitEuler", {"integrator={\"type\":\"implicit_euler\",\"damping\":0.1}"}, "integrator.damping", "is not a known key"},
      {"VerletDampingAboveOne", {"integrator={\"type\":\"verlet\",\"damping\":1.5}"}, "integrator.damping", "must be between 0 and 1"},
      {"VerletDampedTwice", {"integrator={\"type\":\"verlet\",\"damping\":0.1,\"damping_rate\":1}"}, "integrator", "may have only one of damping, damping_rate"},
      {"StartAtRestIsANumber", {"integrator={\"type\":\"verlet\",\"start_at_rest\":1}"}, "integrator.start_at_rest", "must be true or false"},
      {"NegativeStretch", {"stretch_limit.max_stretch=-0.1"}, "stretch_limit.max_stretch", "must be at least 0"},
      {"CompressionAboveOne", {"stretch_limit.max_compression=2"}, "stretch_limit.max_compression", "must be between 0 and 1"},
      {"UnknownKind", {"stretch_limit.kinds=[\"structure\"]"}, "stretch_limit.kinds[0]", "did you mean \"structural\"?"},
      {"NoKinds", {"stretch_limit.kinds=[]"}, "stretch_limit.kinds", "must have at least 1 entry"},
      {"HalfAnIteration", {"stretch_limit.iterations=0.5"}, "stretch_limit.iterations", "must be a whole number"},
      {"NoIterations", {"stretch_limit.iterations=0"}, "stretch_limit.iterations", "must be at least 1"},
      {"UnknownLimitSolver", {"stretch_limit.solver=newtom"}, "stretch_limit.solver", "did you mean \"newton\"?"},
      {"TethersByNumber", {"stretch_limit.tethers=2"}, "stretch_limit.tethers", "must be true or false"},
      {"UnknownStart", {"contact.start=push"}, "contact.start", "must be one of refuse, push_out"},
      {"StartIsTrue", {"contact.start=true"}, "contact.start", "must be one of refuse, push_out"},
      {"UnknownResponse", {"contact.response=projected"}, "contact.response", "did you mean \"projection\"?"},
      {"PenaltyWithoutStiffness", {"contact={\"response\":\"penalty\",\"damping\":1}"}, "contact.stiffness", "is missing"},
      {"StiffnessOfProjection", {"contact={\"response\":\"projection\",\"stiffness\":10}"}, "contact.stiffness", "is not a known key; only \"response\": \"penalty\" has it"},
      {"UnknownStability", {"stability=ignore"}, "stability", "must be one of refuse, warn"},
      {"NegativeMass", {"bodies.banner.mass=-0.2"}, "bodies.banner.mass", "must be greater than 0"},
      {"NoMass", {"bodies.banner.mass=null"}, "bodies.banner", "must have one of mass, particle_mass, density"},
      {"TwoMasses", {"bodies.banner.density=1"}, "bodies.banner", "it has mass, density: remove all but one"},
      {"NegativeStiffness", {"bodies.banner.springs.structural.stiffness=-400"}, "bodies.banner.springs.structural.stiffness", "must be at least 0"},
      {"NegativeSpringDamping", {"bodies.banner.springs.structural.damping=-1"}, "bodies.banner.springs.structural.damping", "must be at least 0"},
      {"NeitherStiffnessNorModulus", {"bodies.banner.springs.bend={}"}, "bodies.banner.springs.bend", "must have one of stiffness, modulus"},
      {"StiffnessAndModulus", {"bodies.banner.springs.structural.modulus=1"}, "bodies.banner.springs.structural", "may have only one of stiffness, modulus"},
      {"UnknownSpringKind", {"bodies.banner.springs.bending.stiffness=1"}, "bodies.banner.springs.bending", "did you mean \"bend\"?"},
      {"UnknownShape", {"bodies.banner.shape.type=clot"}, "bodies.banner.shape.type", "did you mean \"cloth\"?"},
      {"ResolutionOfOne", {"bodies.banner.shape.resolution=[1,3]"}, "bodies.banner.shape.resolution[0]", "must be at least 2"},
      {"ResolutionOfAHalf", {"bodies.banner.shape.resolution=[2.5,3]"}, "bodies.banner.shape.resolution[0]", "must be a whole number"},
      {"ResolutionOfThree", {"bodies.banner.shape.resolution=[3,3,3]"}, "bodies.banner.shape.resolution", "must have 2 entries; it has 3"},
      {"HugeResolution", {"bodies.banner.shape.resolution=[1e20,3]"}, "bodies.banner.shape.resolution[0]", "must be at most"},
      {"HugeResolutionInAll", {"bodies.banner.shape.resolution=[100000,100000]"}, "bodies.banner.shape.resolution", "particles in all", false},
      {"SizeOfZero", {"bodies.banner.shape.size=[0,1]"}, "bodies.banner.shape.size[0]", "must be greater than 0"},
      {"RopeWithoutEnd", {"bodies.banner.shape={\"type\":\"rope\",\"from\":[0,0,0],\"particles\":3}", "bodies.banner.pins=[]"}, "bodies.banner.shape.to", "is missing"},
      {"RopeOfNothing", {"bodies.banner.shape={\"type\":\"rope\"}", "bodies.banner.pins=[]"}, "bodies.banner.shape", "must have one of from, points"},
      {"RopeTwice", {"bodies.banner.shape={\"type\":\"rope\",\"from\":[0,0,0],\"to\":[1,0,0],\"particles\":3,\"points\":[[0,0,0],[1,0,0]]}", "bodies.banner.pins=[]"}, "bodies.banner.shape", "may have only one of from, points"},
      {"PolylineOfOnePoint", {"bodies.banner.shape={\"type\":\"rope\",\"points\":[[0,0,0]]}", "bodies.banner.pins=[]"}, "bodies.banner.shape.points", "must have at least 2 entries"},
      {"RopeOfNegativeLength", {"bodies.banner.shape={\"type\":\"rope\",\"points\":[[0,0,0],[1,0,0]],\"length\":-1}", "bodies.banner.pins=[]"}, "bodies.banner.shape.length", "must be greater than 0"},
      {"MeshWithoutFile", {"bodies.banner.shape={\"type\":\"mesh\",\"file\":\"\"}", "bodies.banner.pins=[]"}, "bodies.banner.shape.file", "must not be empty"},
      {"ScaleOfZero", {"bodies.banner.place.scale=0"}, "bodies.banner.place.scale", "must be greater than 0"},
      {"CornerOfAnotherShape", {"bodies.banner.pins[0].which=[\"from\"]"}, "bodies.banner.pins[0].which[0]", "must be one of min_min, max_min, min_max, max_max", false},
      {"CornerMisspelt", {"bodies.banner.pins[0].which=[\"min_mn\"]"}, "bodies.banner.pins[0].which[0]", "did you mean \"min_min\"?"},
      {"CornerOfAMesh", {"bodies.banner.shape={\"type\":\"mesh\",\"file\":\"a.obj\"}"}, "bodies.banner.pins[0].at", "other shapes have no named corners", false},
      {"PinOfNothing", {"bodies.banner.pins=[{}]"}, "bodies.banner.pins[0]", "must have one of at, indices, nearest, box"},
      {"PinOfTwoKinds", {"bodies.banner.pins[0].nearest=[0,0,0]"}, "bodies.banner.pins[0]", "may have only one of"},
      {"PinAtAnEdge", {"bodies.banner.pins=[{\"at\":\"edge\",\"which\":[\"min_y\"]}]"}, "bodies.banner.pins[0].at", "must be \"corner\"; pin other particles by indices, nearest or box"},
      {"PinOfNegativeIndex", {"bodies.banner.pins=[{\"indices\":[-1]}]"}, "bodies.banner.pins[0].indices[0]", "must be at least 0"},
      {"PinOfNoIndex", {"bodies.banner.pins=[{\"indices\":[]}]"}, "bodies.banner.pins[0].indices", "must have at least 1 entry"},
      {"BoxUpsideDown", {"bodies.banner.pins=[{\"box\":[[0,1,0],[1,0,1]]}]"}, "bodies.banner.pins[0].box", "must begin with the smaller coordinates", false},
      {"KeyframesOutOfOrder", {"obstacles.floor.motion.keyframes=[{\"time\":1},{\"time\":1}]"}, "obstacles.floor.motion.keyframes[1].time", "must be later", false},
      {"KeyframeWithoutTime", {"obstacles.floor.motion.keyframes=[{}]"}, "obstacles.floor.motion.keyframes[0].time", "is missing"},
      {"NoKeyframes", {"obstacles.floor.motion.keyframes=[]"}, "obstacles.floor.motion.keyframes", "must have at least 1 entry"},
      {"UnknownInterpolation", {"obstacles.floor.motion.interpolation=cubic"}, "obstacles.floor.motion.interpolation", "must be one of linear, smooth"},
      {"SpinIsANumber", {"obstacles.floor.motion.spin=90"}, "obstacles.floor.motion.spin", "must be a list"},
      {"RestitutionAboveOne", {"obstacles.floor.restitution=1.1"}, "obstacles.floor.restitution", "must be between 0 and 1"},
      {"StaticFrictionBelowFriction", {"bodies.banner.friction=0.5", "bodies.banner.static_friction=0.4"}, "bodies.banner.static_friction", "must be at least friction, 0.5", false},
      {"NegativeThickness", {"bodies.banner.thickness=-0.001"}, "bodies.banner.thickness", "must be at least 0"},
      {"NormalOfZero", {"obstacles.floor.shape.normal=[0,0,0]"}, "obstacles.floor.shape.normal", "must not be zero", false},
      {"RadiusOfZero", {"obstacles.floor.shape={\"type\":\"sphere\",\"radius\":0}"}, "obstacles.floor.shape.radius", "must be greater than 0"},
      {"RadiusOfABox", {"obstacles.floor.shape={\"type\":\"box\",\"radius\":1}"}, "obstacles.floor.shape.size", "is missing"},
      {"SequenceWithoutFiles", {"obstacles.floor.shape={\"type\":\"sequence\"}"}, "obstacles.floor.shape.files", "is missing"},
      {"SequenceOfOneFile", {"obstacles.floor.shape={\"type\":\"sequence\",\"files\":[\"a.obj\"]}"}, "obstacles.floor.shape.files", "must have at least 2 entries"},
      {"SequenceFileIsANumber", {"obstacles.floor.shape={\"type\":\"sequence\",\"files\":[\"a.obj\",3]}"}, "obstacles.floor.shape.files[1]", "must be a string"},
      {"SequenceFilesAreANumber", {"obstacles.floor.shape={\"type\":\"sequence\",\"files\":7}"}, "obstacles.floor.shape.files", "must be a list of files, or a pattern"},
      {"SequencePatternWithoutStar", {"obstacles.floor.shape={\"type\":\"sequence\",\"files\":\"a.obj\"}"}, "obstacles.floor.shape.files", "must have one * in the name of the file"},
      {"SequencePatternWithTwoStars", {"obstacles.floor.shape={\"type\":\"sequence\",\"files\":\"a*b*.obj\"}"}, "obstacles.floor.shape.files", "must have one * in the name of the file"},
      {"SequencePatternOfFolders", {"obstacles.floor.shape={\"type\":\"sequence\",\"files\":\"*/a.obj\"}"}, "obstacles.floor.shape.files", "must have one * in the name of the file"},
      {"SequenceFrameRateOfZero", {"obstacles.floor.shape={\"type\":\"sequence\",\"files\":\"*.obj\",\"frame_rate\":0}"}, "obstacles.floor.shape.frame_rate", "must be greater than 0"},
      {"SequenceStartIsText", {"obstacles.floor.shape={\"type\":\"sequence\",\"files\":\"*.obj\",\"start\":\"now\"}"}, "obstacles.floor.shape.start", "must be a number"},
      {"SequenceLoopIsANumber", {"obstacles.floor.shape={\"type\":\"sequence\",\"files\":\"*.obj\",\"loop\":1}"}, "obstacles.floor.shape.loop", "must be true or false"},
      {"NameEndsInADigit", {"obstacles.floor2.shape={\"type\":\"sphere\",\"radius\":1}"}, "obstacles.floor2", "must not end in a digit"},
      {"NameWithASlash", {"bodies.a/b.shape={\"type\":\"mesh\",\"file\":\"a.obj\"}", "bodies.a/b.mass=1"}, "bodies.a/b", "letters, digits, _ and -"},
      {"NameIsTooLong", {"obstacles." + std::string(201, 'x') + ".shape={\"type\":\"sphere\",\"radius\":1}"}, "obstacles." + std::string(201, 'x'), "at most 200 letters"},
      {"NameIsReserved", {"bodies.obstacles.shape={\"type\":\"mesh\",\"file\":\"a.obj\"}", "bodies.obstacles.mass=1"}, "bodies.obstacles", "the name is reserved"},
  };
  return kScenes;
}
// clang-format on

}  // namespace sprung
