"""What must not be deformed, model by model, with the reason; a new refusal, or one that went, is a failure."""

INVALID, UNSUPPORTED = 4, 6

# model -> (exit code, a word of the message, reason)
REFUSED = {
    "gltf/assetgen/Positive/Compatibility/Compatibility_04.gltf":
        (UNSUPPORTED, "minVersion", "asset.minVersion is 2.1: the file asks for a newer reader"),
    "gltf/gltf-transform/cli/test/in/ACMEBox.gltf":
        (UNSUPPORTED, "ACME_gizmo", "extensionsRequired names an extension that nobody knows"),
    "obj/ufbx/synthetic_partial_attrib_0_obj.obj":
        (INVALID, "vertex index 0", "a face has the vertex index 0, and OBJ counts from 1"),
}

# The same, in scene space only: in mesh space nodes and skins do not matter.
REFUSED_IN_SCENE = {
    "gltf/tinygltf/regression/unassigned-skeleton.gltf":
        (INVALID, "inverse bind matrix 0", "an inverse bind matrix of numbers from nowhere, last row not 0 0 0 1"),
    "gltf/draco/CubeScaledInstances/glTF/cube_att.gltf":
        (INVALID, "child of both node 1 and node 2", "node 5 has two parents, which glTF forbids"),
    "gltf/khronos/SimpleInstancing/glTF-Binary/SimpleInstancing.glb":
        (UNSUPPORTED, "EXT_mesh_gpu_instancing", "one mesh cannot follow the field at every instance"),
}

# What a lattice that holds nothing of the model does not mind.
FINE_BESIDE = {
    "gltf/khronos/SimpleInstancing/glTF-Binary/SimpleInstancing.glb",
}

# Every kind of file and of storage once: the quick run.
QUICK = {
    "gltf/assetgen/Positive/Animation_Skin/Animation_Skin_10.gltf",
    "gltf/assetgen/Positive/Compatibility/Compatibility_04.gltf",
    "gltf/assetgen/Positive/Instancing/Instancing_06.gltf",
    "gltf/assetgen/Positive/Instancing/Instancing_08.gltf",
    "gltf/assetgen/Positive/Node_NegativeScale/Node_NegativeScale_12.gltf",
    "gltf/cesium-native/CesiumGltfContent/test/data/cubeQuantized.glb",
    "gltf/derived/AnimatedMorphSphere_quantized.glb",
    "gltf/derived/Fox_meshopt.glb",
    "gltf/derived/MorphPrimitivesTest_sparse.glb",
    "gltf/derived/character_draco.glb",
    "gltf/draco/CubeScaledInstances/glTF/cube_att.gltf",
    "gltf/gltf-transform/cli/test/in/ACMEBox.gltf",
    "gltf/gltf-transform/extensions/test/in/BoxMeshopt.glb",
    "gltf/gltf-transform/functions/test/in/ShapeCollection.glb",
    "gltf/khronos/AnimatedMorphCube/glTF-Binary/AnimatedMorphCube.glb",
    "gltf/khronos/AnimatedMorphCube/glTF-Quantized/AnimatedMorphCube.gltf",
    "gltf/khronos/MorphPrimitivesTest/glTF-Draco/MorphPrimitivesTest.gltf",
    "gltf/khronos/MultipleScenes/glTF/MultipleScenes.gltf",
    "gltf/khronos/RiggedFigure/glTF-Binary/RiggedFigure.glb",
    "gltf/khronos/RiggedFigure/glTF-Draco/RiggedFigure.gltf",
    "gltf/khronos/SimpleInstancing/glTF-Binary/SimpleInstancing.glb",
    "gltf/khronos/SimpleMorph/glTF/SimpleMorph.gltf",
    "gltf/khronos/SimpleSkin/glTF-Embedded/SimpleSkin.gltf",
    "gltf/khronos/SimpleSparseAccessor/glTF/SimpleSparseAccessor.gltf",
    "gltf/tinygltf/regression/unassigned-skeleton.gltf",
    "obj/crafted/cr_only.obj",
    "obj/crafted/double_precision.obj",
    "obj/crafted/freeform_bezier_patch.obj",
    "obj/crafted/line_continuation.obj",
    "obj/crafted/negative_interleaved.obj",
    "obj/crafted/vertex_colors_mixed.obj",
    "obj/crafted/w_component.obj",
    "obj/ufbx/blender_340_mirrored_normals.obj",
    "obj/ufbx/synthetic_partial_attrib_0_obj.obj",
    "other/assimp/OFF/Cube.off",
    "other/assimp/PLY/cube_binary.ply",
    "other/draco/STL/test_sphere.stl",
    "other/draco/cube_att.ply",
    "other/draco/test_extra_whitespace.ply",
    "other/pmp/stl/icosahedron_ascii.stl",
}
