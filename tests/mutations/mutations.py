"""The mutations that run.py plants, by the folder in which each has its text today.

m(NAME, KIND, TESTS, FIND, REPLACE[, FIND, REPLACE]...): FIND is code without comments that is in src once, blanks
aside; further pairs are for commits in which the first text is another one. TESTS are names of meson tests, quick ones
first, separated by commas; "old name|new name" where a test is renamed. A mutation that no test can catch, as it
changes nothing that the program promises (a limit of effort, a read within the same page), is none for this table.
"""

from typing import NamedTuple


class Mutation(NamedTuple):
    name: str
    kind: str
    tests: list
    edits: list


MUTATIONS = []


def m(name, kind, tests, *texts):
    edits = list(zip(texts[::2], texts[1::2]))
    MUTATIONS.append(Mutation(name, kind, [test.strip() for test in tests.split(",")], edits))


# base

m("output-not-renamed", "rename left out", "file, cli_output",
  "(stays ? unlink(file->temporary) : rename(file->temporary, file->target)) != 0",
  "(stays ? unlink(file->temporary) : 0) != 0")
m("close-not-checked", "close check left out", "file, cli_full_disk, cli_output",
  "(twin < 0 || close(twin) != 0)", "(twin < 0 || (close(twin) != 0 && twin < 0))")
m("output-not-locked", "lock left out", "file, cli_output, cli_batch_signals",
  "flock(fd, LOCK_EX | LOCK_NB) != 0", "flock(fd, LOCK_UN) != 0")
m("block-overrun", "bound", "file, cli_output",
  "size > BLOCK - output->filled ? flush(output, error)", "size > BLOCK ? flush(output, error)")
m("mode-not-kept", "file mode", "file, cli_output", "old->st_mode & 0777", "old->st_mode & 0666")
m("output-left-open", "freed resource", "file, cli_many", "if (file->fd >= 0) close(file->fd);",
  "if (file->fd >= 1000000)\n            close(file->fd);")
m("leftover-not-removed", "clean-up left out", "file, cli_output, cli_full_disk",
  "if (file->temporary && !file->committed) unlink(file->temporary);",
  "if (file->temporary && file->committed) unlink(file->temporary);")
m("spill-left-open", "freed resource", "spill", "munmap(array->data, array->size); close(array->file);",
  "munmap(array->data, array->size);")
m("files-of-a-parent", "owner check left out", "cleanup", "if (entry->owner != getpid()) continue;",
  "if (entry->owner == 0) continue;")
m("crash-clean-up-left-out", "clean-up left out", "cleanup, cli_batch_failures", "if (tries > 0) remove_all();",
  "if (tries > 1000) remove_all();")
m("greatest-of-group", "kernel", "array",
  "range->max[k] = value > range->max[k] ? value : range->max[k];",
  "range->max[k] = value < range->max[k] ? value : range->max[k];")
m("last-tile-too-long", "bound", "base", "begin + (rest < of->tile_size ? rest : of->tile_size)",
  "begin + (rest < 1 ? rest : of->tile_size)")
m("order-of-tiles", "operation", "base, cli_obj", "if (work->slots[i].made && work->slots[i].tile == tile)",
  "if (work->slots[i].made && work->slots[i].tile >= tile)")
m("two-finish-at-once", "lock left out", "base, cli_obj, cli_many",
  "if (work->finishing) return; work->finishing = true;", "work->finishing = true;")
m("set-torn-by-a-signal", "lock left out", "cleanup, file, cli_output, cli_batch_signals",
  "ffd_cleanup_hold(); status = settle_all(output, stays, error); ffd_cleanup_release();",
  "status = settle_all(output, stays, error);")
m("exit-of-unsupported", "error code", "base", "case FFD_E_UNSUPPORTED: return 6;", "case FFD_E_UNSUPPORTED: return 4;")
m("control-characters-shown", "message", "base, cli_errors",
  "if (*c < 0x20 || *c == 0x7f) *c = '?'; } static void fill",
  "if (*c < 0x20 && *c == 0x7f) *c = '?'; } static void fill")
m("long-names-alike", "limit", "cli_aliases",
  'length + sizeof "." NAME_SUFFIX - 1 <= LONGEST_NAME', 'length + sizeof "." NAME_SUFFIX - 1 <= 2 * LONGEST_NAME')
m("hash-of-doubles", "stride", "embedding_file, base", "store_double(bytes + 8 * i, values[done + i]);",
  "store_double(bytes + 8 * i, values[i]);")
m("ties-of-decimals", "rounding", "number",
  "const uint64_t nearest = whole + (part + (whole & 1) > unit / 2);",
  "const uint64_t nearest = whole + (part > unit / 2);")
m("too-large-a-number", "bound", "number", "return exponent + point - leading > 0;",
  "return exponent + point - leading > 400;")
m("sine-of-45", "rounding", "trig", "if (size == 45)", "if (size == 46)")
m("utf8-surrogates", "check left out", "base, json_span", "(first == 0xed && c[1] > 0x9f)",
  "(first == 0xed && c[1] > 0xbf)",
  "*code > 0x10ffff || (*code >= 0xd800 && *code <= 0xdfff)", "*code > 0x10ffff")
m("null-for-infinity", "format", "base", "if (isfinite(value)) ffd_buffer_number(json->out, value);",
  "if (!isnan(value))\n        ffd_buffer_number(json->out, value);")

# spline

m("basis-derivative", "sign", "basis, spline_properties",
  "const double quotient = value[r] * (d / (right[r] - left[r])); derivative[r] = before - quotient;",
  "const double quotient = value[r] * (d / (right[r] - left[r])); derivative[r] = quotient - before;")
m("bezier-row", "off by one", "spline_properties, displacement, locator, fold", "degree <= r ? last : first",
  "degree < r ? last : first")
m("seam-multiplicity", "limit", "knots", "if (multiplicity <= (size_t)list->degree)",
  "if (multiplicity <= (size_t)list->degree + 1)")
m("period", "sign", "knots, basis", "b[n + m] = b[n] + (b[m] - b[0]);", "b[n + m] = b[n] + (b[m] + b[0]);")
m("preset-knots", "off by one", "knots", "t[i] = (double)(i - d) / (n - d);", "t[i] = (double)(i - d) / (n - d + 1);")

# lattice

m("rational-derivative", "sign", "evaluate, oracle evaluate", "(sum.by_v[r] - value[r] * sum.by_v[3]) / weight",
  "(sum.by_v[r] + value[r] * sum.by_v[3]) / weight")
m("seam-tolerance", "tolerance", "shapes, embedding_file, locator",
  "tolerance[a] = 16 * DBL_EPSILON * extent;", "tolerance[a] = 0 * extent;")
m("rotation", "sign", "moves, oracle moves", "+ ready->sine * f[c];", "- ready->sine * f[c];")
m("within-slack", "tolerance", "moves, oracle moves", "x[c] >= move->within_min[c] - work->slack[c]",
  "x[c] >= move->within_min[c]")
m("bend-of-small-angles", "rounding", "moves, oracle moves",
  "cosine > 0.5 ? 2 * half_sine * half_sine : 1 - cosine", "cosine > 2 ? 2 * half_sine * half_sine : 1 - cosine")
m("weight-of-zero", "limit", "lattice_file, cli_errors", "!status && !((*weights)[i] > 0)",
  "!status && !((*weights)[i] >= 0)")
m("cylinder-margin", "factor", "shapes, cli_lattice_new", "radius * (1 + 2 * desc->margin)",
  "radius * (1 + desc->margin)")
m("lattice-member", "member name", "lattice_file, shapes, cli_lattice_new", '"height", spec->height',
  '"radius", spec->height')

# deform

m("kernel-sum", "kernel", "displacement", "sum[c] = i == 0 ? term : sum[c] + term;",
  "sum[c] = i == 0 ? term : sum[c] - term;")
m("kernel-power", "kernel", "displacement", "power[degree] = power[degree - 1] * t;",
  "power[degree] = power[degree - 1] * t * rest;")
m("kernel-transposed", "stride", "displacement", "m[3 * r + c] = sum->part[1 + c][r];",
  "m[3 * r + c] = sum->part[1 + r][c];")
m("kernel-gaps", "stride", "displacement, deform", "which[FFD_LANES - 1] - which[0] == FFD_LANES - 1",
  "which[FFD_LANES - 1] - which[0] >= FFD_LANES - 1")
m("collapsed-normal", "tolerance", "deform", "!(length > 16 * DBL_EPSILON * scale)",
  "!(length > 0 * scale)")
m("tangent", "sign", "deform, attribute_batch",
  "const double along = vec_dot(carried, normal); for (int a = 0; a < 3; a++) carried[a] -= along * normal[a];",
  "const double along = vec_dot(carried, normal); for (int a = 0; a < 3; a++) carried[a] += along * normal[a];")
m("cells-of-gradients", "check left out", "displacement, pass", "kept->lattice == lattice && kept->use == use",
  "kept->lattice == lattice")
m("kept-cell-of-another", "check left out", "displacement, deform", "if (kept->keys[slot] != cell->key + 1)",
  "if (kept->keys[slot] == 0)")
m("fade-slope", "sign", "extension", "*slope = -30 * (s * s) * (rest * rest) / falloff;",
  "*slope = 30 * (s * s) * (rest * rest) / falloff;")
m("lanes-of-tangents", "kernel", "attribute_batch", "const lanes along = lanes_dot(carried, normal);",
  "const lanes along = lanes_dot(tangent, normal);")

# embed

m("separable-stride", "stride", "locator", "a == 1 ? lattice->size[0] : lattice->size[0] * lattice->size[1];",
  "a == 1 ? lattice->size[0] : lattice->size[1] * lattice->size[1];")
m("separable-tolerance", "tolerance", "locator, oracle embedding", "p[a] < fmin(first, last) - tolerance[a]",
  "p[a] < fmin(first, last) + tolerance[a]")
m("roots-across-seam", "seam", "locator, oracle embedding", "apart = side_of(locator, d) - apart;",
  "apart = side_of(locator, d);")
m("tree-child", "bit", "box_tree, locator", "((unsigned)meets[1] & 2) << i", "((unsigned)meets[1] & 1) << i")
m("foot-side", "sign", "boundary, extension", "foot->residual[c] = -at.sample.residual[c];",
  "foot->residual[c] = at.sample.residual[c];")
m("foot-follows", "sign", "boundary, extension", "rows[0][c] = (h[2] * s - h[1] * t) / det;",
  "rows[0][c] = (h[2] * s + h[1] * t) / det;")
m("hard-budget", "limit", "locator, oracle embedding", "#define HARD_BUDGET 4096", "#define HARD_BUDGET 4")
m("contraction-slope", "kernel", "contraction, locator",
  "degree * ((i > 0 ? lower[i - 1] : 0) - (i < degree ? lower[i] : 0));",
  "degree * ((i > 0 ? lower[i - 1] : 0) + (i < degree ? lower[i] : 0));")
m("affine-refinement", "rounding", "locator, oracle embedding", "#define REFINEMENTS 8", "#define REFINEMENTS 0")
m("halved-coefficients", "kernel", "locator, fold, boundary", "high[x] = 0.5 * high[x] + 0.5 * high[x + inner];",
  "high[x] = 0.25 * high[x] + 0.75 * high[x + inner];")
m("brick-at-the-end", "bound", "locator, oracle embedding", "last[a] = first[a] + BRICK_SIDE - 1;",
  "last[a] = first[a] + BRICK_SIDE - 2;")
m("search-equation", "sign", "locator, oracle embedding",
  "at->equation[r] = value.value[r] - search->x[r] * value.value[3];",
  "at->equation[r] = value.value[r] + search->x[r] * value.value[3];")
m("lanes-radius", "kernel", "locator, oracle embedding", "result->evaluations[l] += which[l] != 0;",
  "result->evaluations[l] += which[l] == 0;")
m("mixed-derivative", "operation", "boundary, extension",
  "(sum[BY_ST][c] - s * wt - t * ws - value * sum[BY_ST][3]) / w;",
  "(sum[BY_ST][c] - s * wt - t * ws + value * sum[BY_ST][3]) / w;")
m("origin-added", "sign", "locator", "p[a] = xyz[a] - locator->origin[a];", "p[a] = xyz[a] + locator->origin[a];")

# fold

m("laplace-sign", "sign", "fold, oracle folds", "pair_sign[6] = {1, -1, 1, 1, -1, 1};",
  "pair_sign[6] = {1, -1, 1, 1, 1, 1};")
m("zeros-of-two-coordinates", "bound", "fold, oracle folds",
  "for (size_t r = 0; r < 3; r++) if (points[3 * i + r] != points[3 * j + r]) return false; return !weights",
  "for (size_t r = 0; r < 2; r++)\n        if (points[3 * i + r] != points[3 * j + r])\n            return false;\n"
  "    return !weights")
m("volume-of-faces", "sign", "fold, oracle folds", "const double sign = end ? 1 : -1; fill_net",
  "const double sign = end ? -1 : 1; fill_net")
m("witness-in-the-cell", "bound", "oracle folds", "return is_last ? knot[1] : nextafter(knot[1], knot[0]);",
  "return is_last ? knot[0] : nextafter(knot[1], knot[0]);")
m("unknown-cells", "operation", "fold, oracle folds, cli_check", "folds->unknown_cells += tile->unknown;",
  "folds->unknown_cells += tile->folded;")
m("weights-of-bound", "operation", "oracle folds", "/ weight / weight / weight * (1 - 1e-12)",
  "/ weight / weight / weight / weight / weight * (1 - 1e-12)")
m("refined-bound", "tolerance", "fold, oracle folds", "least_seen - 0.01 * fabs(least_seen);",
  "least_seen - 0.9 * fabs(least_seen);")

# mesh

m("one-corner-is-a-point", "operation", "model, cli_convert", "if (kind == MODEL_POINTS || count == 1)",
  "if (kind == MODEL_POINTS)")
m("triangles-are-polygons", "bound", "model, cli_convert", "faces->corner_count > 3 * faces->count",
  "faces->corner_count >= 3 * faces->count")
m("colours-as-bytes", "tolerance", "model, cli_convert", "#define BYTE_TOLERANCE 2e-4", "#define BYTE_TOLERANCE 2e-1")
m("fine-positions", "tolerance", "model, cli_convert", "#define FLOAT_TOLERANCE 0x1p-17",
  "#define FLOAT_TOLERANCE 0x1p-9")
m("polygon-seen-from-below", "sign", "polygon_cut, cli_convert", "(axis + (normal[axis] < 0 ? 2 : 1)) % 3",
  "(axis + (normal[axis] > 0 ? 2 : 1)) % 3")
m("reflex-angle", "operation", "normals, cli_normals", "ffd_arc_tangent(0, -1) * 2 - angle : angle;",
  "ffd_arc_tangent(0, -1) - angle : angle;")

# io

m("splice-copied", "off by one", "obj, ply, off, stl",
  "at += format(run, numbers + i, at); splice->copied = words[i].last;",
  "at += format(run, numbers + i, at); splice->copied = words[i].first;")
m("line-of-text", "line number", "off, ply, stl, cli_errors",
  "scan->at[1] == '\\n' ? 2 : 1; scan->line++; return true;",
  "scan->at[1] == '\\n' ? 2 : 1; return true;")
m("whole-number-wraps", "limit", "off, stl, cli_off_stl",
  "*value > (UINT64_MAX - digit) / 10 ? UINT64_MAX : *value * 10 + digit", "*value * 10 + digit")
m("utf8-cut", "bound", "off, ply, obj, stl, cli_errors", "((unsigned char)word.first[shown] & 0xc0) == 0x80)",
  "((unsigned char)word.first[shown] & 0xc0) == 0xc0)")
m("npy-alignment", "off by one", "embedding_file, cli_embed", "while ((size + 1) % ALIGNMENT != 0)",
  "while (size % ALIGNMENT != 0)")
m("npy-order", "format", "embedding_file, cli_embed", "'fortran_order': False", "'fortran_order': True")
m("ending-of-ply", "constant", "source, cli_ply", '{".ply", FFD_FORMAT_PLY}', '{".ply", FFD_FORMAT_OFF}')

# io/obj

m("added-normal-number", "off by one", "obj_normals, obj, cli_obj",
  "(uint64_t)all->document->normals + target + 1;", "(uint64_t)all->document->normals + target;")
m("added-line-end", "off by one", "obj_normals, obj, cli_obj",
  "where[-2] == '\\r' ? 2 : 1)", "where[-2] == '\\r' ? 1 : 1)",
  "place[-2] == '\\r' ? 2 : 1)", "place[-2] == '\\r' ? 1 : 1)")
m("index-counts-back", "sign", "obj, obj_users", "index->value = -index->value;", "index->value = index->value - 1;")
m("backslash-at-the-end", "bound", "obj, cli_obj",
  "return scan->last - at == 1 || ffd_obj_class(at + 1) == OBJ_LINE_END;",
  "return scan->last - at == 2 || ffd_obj_class(at + 1) == OBJ_LINE_END;")
m("greatest-element", "off by one", "obj_users, obj", "*greatest = *greatest > element ? *greatest : element + 1;",
  "*greatest = *greatest > element ? *greatest : element;")
m("block-cut-in-a-line", "bound", "obj_blocks", "if (!may_continue(first, end)) return at; at--;",
  "if (!may_continue(first, end) || at < last)\n            return at;\n        at--;")
m("digits-of-a-number", "bound", "obj, number, bytes", "count < 1 || count > 16)", "count < 1 || count > 17)")

# io/gltf

m("base64-padding", "bound", "gltf, gltf_save, gltf_storage, cli_gltf_storage, cli_convert",
  "left > 1 ? digits[bits >> 6 & 63] : '=';", "left > 2 ? digits[bits >> 6 & 63] : '=';")
m("chunk-size", "bound", "gltf, cli_broken_gltf", "if (chunk->size > end - chunk->begin)", "if (chunk->size > end)")
m("normalized-rounding", "rounding", "gltf_save, gltf_storage, gltf_models", "rint(value * scale) / scale + 0.0",
  "floor(value * scale) / scale + 0.0")
m("accessor-bounds", "kernel", "gltf_storage, gltf_save, cli_gltf_storage, validator",
  "const float value = xyz[3 * first + k]; least[k] = value < least[k] ? value : least[k];",
  "const float value = xyz[3 * first + k]; least[k] = value > least[k] ? value : least[k];")
m("inverse-bind-transposed", "stride", "cli_gltf_scene, gltf_models, scene", "matrix[3 * r + c] = read[4 * c + r];",
  "matrix[3 * r + c] = read[4 * r + c];")
m("last-row", "tolerance", "gltf, cli_gltf_scene, cli_broken_gltf, broken_gltf", "#define LAST_ROW_TOLERANCE 1e-5",
  "#define LAST_ROW_TOLERANCE 1e5")
m("buffer-too-short", "bound", "gltf, cli_broken_gltf, cli_broken_files",
  "buffer->kind != BUFFER_EMPTY && buffer->size < buffer->length",
  "buffer->kind != BUFFER_EMPTY && buffer->size + 4 < buffer->length")
m("absolute-uri", "check left out", "gltf, cli_broken_gltf", "if (uri[0] == '/' || uri[0] == '\\\\')",
  "if (uri[0] == '\\\\')")
m("instances-out-of-reach", "bound", "cli_gltf_scene, gltf, scene",
  "if (least > reach->max[r] || largest < reach->min[r])",
  "if (least > reach->max[r] && largest < reach->min[r])")
m("normalized-least", "bound", "gltf_storage", "return value / scale < -1 ? -1 : value / scale;",
  "return value / scale;")
m("sparse-index", "endian", "gltf, gltf_models, cli_gltf_storage", "return at[0] | (uint32_t)at[1] << 8;",
  "return at[1] | (uint32_t)at[0] << 8;")
m("sparse-behind-the-tile", "bound", "gltf_storage, gltf, gltf_models", "if (index - first >= count) return;",
  "if (index - first > count)\n            return;")
m("json-depth", "limit", "json_span, gltf, replay gltf", "if (++*depth > JSON_SPAN_DEPTH)",
  "if (++*depth > 2 * JSON_SPAN_DEPTH)")
m("json-equal-keys", "off by one", "json_span, gltf",
  "for (size_t i = 1; i < count && status == FFD_OK; i++) if (compare_members(",
  "for (size_t i = 2; i < count && status == FFD_OK; i++)\n        if (compare_members(",
  "for (size_t i = 1; i < count && status == FFD_OK; i++) if (ffd_json_span_compare_keys(",
  "for (size_t i = 2; i < count && status == FFD_OK; i++)\n        if (ffd_json_span_compare_keys(")
m("draco-clash", "check left out", "gltf_packed, draco, gltf",
  "unpacked->size != size || memcmp(unpacked->bytes, bytes, size) != 0", "unpacked->size != size")
m("draco-too-often", "limit", "gltf_packed, draco", "#define MOST_DECODED_A_BYTE 0.25",
  "#define MOST_DECODED_A_BYTE 1e9")
m("meshopt-triangles", "check left out", "meshopt, gltf_packed", "view->mode == MESHOPT_TRIANGLES && view->count % 3)",
  "view->mode == MESHOPT_TRIANGLES && view->count % 3 > 2)")
m("glb-newer-version", "error code", "gltf, cli_broken_gltf",
  "if (version != GLB_VERSION) return ffd_fail_file(error, FFD_E_UNSUPPORTED,",
  "if (version != GLB_VERSION)\n        return ffd_fail_file(error, FFD_E_INVALID,")
m("primitive-mode", "limit", "cli_broken_gltf, gltf", "return known && number <= 6 ? FFD_OK",
  "return known && number <= 7 ? FFD_OK")
m("files-of-buffers", "operation", "hash_cache, cli_batch_resume, cli_pipeline",
  "if (d->buffers[i].kind != BUFFER_FILE) continue; char *path = ffd_path_beside(d->path, d->buffers[i].path);",
  "if (d->buffers[i].kind != BUFFER_FILE || i == 0)\n            continue;\n"
  "        char *path = ffd_path_beside(d->path, d->buffers[i].path);")
m("extension-is-there", "operation", "gltf, gltf_packed, cli_gltf_scene",
  "return ffd_gltf_extension(d, value, extension) != JSON_NONE;",
  "return ffd_gltf_extension(d, value, extension) == JSON_NONE;")
m("texcoords-go-down", "operation", "cli_convert", "texcoords[2 * i + 1] = 1 - texcoords[2 * i + 1];",
  "texcoords[2 * i + 1] = 0 + texcoords[2 * i + 1];")
m("interleaved-bytes", "bound", "gltf_save, overlap", "distance < x->size || distance + y->size > x->stride;",
  "distance < x->size || distance + y->size >= x->stride;")
m("skins-use-accessors", "member name", "gltf_save, cli_gltf_scene",
  'mark_number(d, ffd_json_span_member(&d->tree, s, "inverseBindMatrices"), used);',
  'mark_number(d, ffd_json_span_member(&d->tree, s, "inverseBindMatrix"), used);')

# io/ply

m("ply-big-endian", "endian", "ply", "(8 * (encoding == PLY_BIG_ENDIAN ? size - 1 - i : i))",
  "(8 * (encoding == PLY_BIG_ENDIAN ? i : size - 1 - i))")
m("ply-sign-of-integers", "bound", "ply, cli_ply", "is_signed && bits >= range / 2", "is_signed && bits > range / 2")
m("ply-rows-do-not-fit", "limit", "ply, cli_ply, replay ply", "e->count > left / e->least",
  "e->count > left / 1")
m("ply-colour-of-shorts", "factor", "ply, model, cli_convert", "type == PLY_USHORT ? 65535 : 1",
  "type == PLY_USHORT ? 65536 : 1")
m("ply-normals-mixed", "stride", "ply, cli_ply",
  "property->slot < PLY_NORMAL_SLOT ? d->file.positions : d->file.directions",
  "property->slot <= PLY_NORMAL_SLOT ? d->file.positions : d->file.directions",
  "property->slot < PLY_NORMAL_SLOT ? d->positions : d->directions",
  "property->slot <= PLY_NORMAL_SLOT ? d->positions : d->directions")
m("ply-newer-version", "error code", "ply, cli_ply",
  'if (!ffd_text_is(version, "1.0")) return ffd_fail_line(r->error, FFD_E_UNSUPPORTED,',
  'if (!ffd_text_is(version, "1.0"))\n        return ffd_fail_line(r->error, FFD_E_INVALID,')

# io/off

m("off-limit", "limit", "off, cli_off_stl, replay off", "if (needed > left + 1)", "if (needed > left + 100000000)")
m("off-texcoords", "off by one", "off, cli_convert, cli_off_stl", "if (texcoords && count >= 2)",
  "if (texcoords && count > 2)")
m("off-free-layout", "operation", "off, cli_off_stl",
  "header->free_layout = in_header_line || !has_vertex_line(header, r->scan);",
  "header->free_layout = in_header_line && !has_vertex_line(header, r->scan);")
m("off-rest-of-a-vertex", "off by one", "off, cli_convert", "if (count != 3 && count != 4) {",
  "if (count != 3 && count != 5) {")

# io/stl

m("stl-normal-side", "sign", "stl, cli_off_stl", "vec_dot(rest, old) < 0)", "vec_dot(rest, old) > 0)")
m("stl-negative-zero", "sign", "stl, cli_off_stl", "normal[a] = 0 - normal[a];", "normal[a] = -normal[a];")
m("stl-too-short", "bound", "stl, cli_off_stl, cli_broken_files",
  "if (stated_size(&d->file.input) > d->file.input.size)",
  "if (stated_size(&d->file.input) > d->file.input.size + 49)",
  "if (stated_size(&d->input) > d->input.size)",
  "if (stated_size(&d->input) > d->input.size + 49)")

# io/openmesh

m("edges-of-two-faces", "operation", "topology, cli_info", "(faces[edge] == 2 && upward[edge] == 1)",
  "(faces[edge] == 2 && upward[edge] <= 2)")
m("fans-of-a-vertex", "bound", "topology", "topology.non_manifold_vertices += fans[v] > 1;",
  "topology.non_manifold_vertices += fans[v] > 2;")
m("mirrored-normals", "sign", "normals, cli_normals", "sign = mirrored && mirrored[terms.vertex(i)] ? -1 : 1;",
  "sign = mirrored && mirrored[terms.vertex(i)] ? 1 : 1;")

# io/write

m("written-colour", "rounding", "cli_convert, model",
  "const unsigned char byte = (unsigned char)floor(255 * value + 0.5);",
  "const unsigned char byte = (unsigned char)floor(255 * value);")
m("count-of-a-long-face", "off by one", "cli_convert", "if (longest > LARGEST_UCHAR)", "if (longest >= LARGEST_UCHAR)")
m("stl-triangles", "count", "cli_convert, cli_off_stl", "ffd_sink_u32(&sink, (uint32_t)triangles);",
  "ffd_sink_u32(&sink, (uint32_t)faces->count);")
m("written-edges", "off by one", "cli_convert", "plan->edges = lines->corner_count - lines->count;",
  "plan->edges = lines->corner_count;")
m("glb-stride", "stride", "cli_convert, validator", "{12, 12, 8, glb_colour_size(w), 12, 12, 0, 0}",
  "{12, 12, 12, glb_colour_size(w), 12, 12, 0, 0}")
m("glb-mode", "constant", "cli_convert", "modes[MODEL_KINDS] = {4, 1, 0};", "modes[MODEL_KINDS] = {4, 3, 0};")
m("glb-vertices-joined", "operation", "cli_convert",
  "if (x->texcoord != y->texcoord) return x->texcoord < y->texcoord ? -1 : 1;",
  "if (x->texcoord != y->texcoord && x->normal != y->normal)\n        return x->texcoord < y->texcoord ? -1 : 1;")
m("obj-name-joins-lines", "format", "cli_convert", "(*c == '\\\\' && !c[1]);", "(*c == '\\\\' && c[1] == '\\\\');")

# job

m("report-rms", "figure", "cli_deform",
  'ffd_json_number(json, "rms", result->residual_rms);', 'ffd_json_number(json, "rms", result->residual_max);')
m("report-member", "member name", "cli_report_schema", '"displacement", true); ffd_json_number(json, "max"',
  '"displacements", true); ffd_json_number(json, "max"')
m("gate-of-multiple", "operation", "cli_fail_on", "if (desc->fail_on & FFD_GATE_MULTIPLE)",
  "if (desc->fail_on & FFD_GATE_SINGULAR)")
m("folds-of-two-lattices", "operation", "job, cli_check, cli_fail_on",
  "verdict == FFD_FOLDS_SOME ? 2 : verdict == FFD_FOLDS_UNKNOWN ? 1 : 0",
  "verdict == FFD_FOLDS_SOME ? 0 : verdict == FFD_FOLDS_UNKNOWN ? 1 : 0")
m("composed-gradient", "operation", "pass, job, cli_pipeline", "gradient[i] = gradient[i] + next[i] + product[i];",
  "gradient[i] = gradient[i] + next[i] + 0 * product[i];")
m("embedding-of-another-lattice", "check left out", "embedding_file, cli_embedding",
  "memcmp(lattice, content->footer + LATTICE, sizeof *lattice) != 0",
  "memcmp(lattice, content->footer + LATTICE, sizeof *lattice) == 1000")
m("status-array", "format", "cli_embed", 'ffd_npy_begin(output, "|u1"', 'ffd_npy_begin(output, "|i1"')
m("kept-mesh-of-another-space", "check left out", "share|job_cache, job_source, cli_batch_shared",
  "a->format != b->format || a->space != b->space", "a->format != b->format")
m("residual-mean", "figure", "cli_deform", "totals->residual_square_sum / (double)totals->located)",
  "totals->residual_square_sum / (double)totals->vertices)")
m("shown-normal-transposed", "stride", "cli_normals, normals",
  "{m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]}; mat_apply(transposed, n, n); } static uint8_t",
  "{m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8]};\n    mat_apply(transposed, n, n);\n}\n\nstatic uint8_t")
m("depfile-quotes", "format", "job, cli_pipeline, cli_output",
  'if (strchr(" \\t#:", *name))', 'if (strchr(" \\t:", *name))')
m("edge-twice", "operation", "quality", "keys[count++] = a < b ? a << 32 | b : b << 32 | a;",
  "keys[count++] = a << 32 | b;")
m("edge-deviation", "tolerance", "quality, cli_check", "#define OVERSHOOT (1 + 1.0 / 64)",
  "#define OVERSHOOT (4 + 1.0 / 64)")
m("merged-exit-code", "bound", "cli_report_merge", "code >= 0 && code <= 7", "code >= 0 && code <= 8")
m("gate-exit", "error code", "cli_fail_on", "return line.length ? ffd_fail_file(error, FFD_E_GATE,",
  "return line.length ? ffd_fail_file(error, FFD_E_INVALID,")
m("shapes-outside", "error code", "cli_outside, cli_gltf_scene, cli_errors",
  "if (desc->outside == FFD_OUTSIDE_ERROR && totals->shapes_outside) return ffd_fail_file(error, FFD_E_EMBEDDING,",
  "if (desc->outside == FFD_OUTSIDE_ERROR && totals->shapes_outside)\n"
  "        return ffd_fail_file(error, FFD_E_INVALID,")
m("range-of-offsets", "sign", "cli_as_morph, cli_convert", "less ? values[i] - less[i] : values[i];",
  "less ? values[i] + less[i] : values[i];")
m("info-member", "member name", "info, cli_info", '"boundary_edges", topology->boundary_edges',
  '"boundary_edge", topology->boundary_edges')

# batch

m("journal-full", "limit", "journal",
  "if (journal->used > journal->slots / 2", "if (journal->used > journal->slots * 2")
m("journal-not-renamed", "rename left out", "journal, cli_batch_resume",
  "fflush(file) == 0 && rename(name, journal->path) == 0", "fflush(file) == 0")
m("journal-torn-record", "check left out", "journal, cli_batch_resume",
  "(is_whole(slot) && ffd_hash_equal(&slot->target, target))", "ffd_hash_equal(&slot->target, target)")
m("shard", "off by one", "job_source, cli_batch", "source->count++ % source->desc.shards == source->desc.shard",
  "++source->count % source->desc.shards == source->desc.shard")
m("csv-quote", "operation", "cli_batch_table", "text[i] == '\"' && i + 1 < size && text[i + 1] == '\"'",
  "text[i] == '\"' && i + 1 < size && text[i + 1] == ','")
m("changed-mesh-is-known", "check left out", "hash_cache, cli_batch_resume",
  "ffd_file_stamp(source->path, &stamp) && ffd_stamp_equal(&stamp, &cache->stamp)",
  "ffd_file_stamp(source->path, &stamp)")
m("resume-without-outputs", "check left out", "cli_batch_resume",
  "&& ffd_hash_equal(&answer->record.outputs, &task->record.outputs);", ";")
m("resume-does-not-replace", "operation", "cli_batch_resume", "desc->force = desc->force || task->resume;",
  "desc->force = desc->force || task->dry;")
m("stop-is-no-failure", "exit code", "cli_batch_failures, cli_batch_signals, cli_batch",
  "*failed = run.counts.failed > 0 || run.dropped;", "*failed = run.counts.failed > 0;")
m("timeout-named-stop", "message", "cli_batch_failures, cli_batch", "worker->timed_out = !worker->stopped;",
  "worker->timed_out = worker->stopped;")

# cli

m("most-threads", "limit", "cli_usage, cli_errors", "count < 1 || count > 1024)", "count < 1 || count > 1000)")
m("size-units", "factor", "cli_usage", "unit *= 1000;", "unit *= 1024;")
m("embedding-of-many", "limit", "cli_usage",
  "if (job->embedding && inputs > 1)", "if (job->embedding && inputs > 2)")
m("exit-of-many", "error code", "cli_deform, cli_many", "code = inputs == 1 ? own : EXIT_NO;", "code = own;")
m("report-over-a-lattice", "check left out", "cli_usage, cli_output, cli_aliases",
  "if (strcmp(job->report, job->lattices[i]) == 0)", "if (strcmp(job->report, job->lattices[i]) == 1000)")
m("named-twice", "off by one", "cli_deform, cli_many",
  "for (size_t i = 1; i < inputs->count && !code; i++)", "for (size_t i = 2; i < inputs->count && !code; i++)")

# cli/pages

m("page-letter", "operation", "install man", "if (option->letter) printf(\"Fl %c , \", option->letter);",
  "if (option->letter == 'q')\n        printf(\"Fl %c , \", option->letter);")
m("completion-of-folders", "operation", "install completion", '"_filedir -d" : ":"', '"_filedir" : ":"')
m("completion-quote", "format", "install completion", "if (*text == '\\'') fputs(\"'\\\\'\", stdout);",
  "if (*text == '\\\"') fputs(\"'\\\\'\", stdout);")
