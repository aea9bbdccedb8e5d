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


# sizes of callers

m("locations-longer-than-the-callers", "size", "older_callers", "memcpy(callers + size * (first + i), &own[i], size);",
  "memcpy(callers + size * (first + i), &own[i], sizeof own[i]);")
m("rounding-of-the-first-points", "index", "older_callers", "allowance->rounding ? allowance->rounding + 3 * first : NULL",
  "allowance->rounding")
m("folds-longer-than-the-callers", "size", "older_callers", "ffd_struct_give(&folds, sizeof folds, callers, callers->struct_size);",
  "ffd_struct_give(&folds, sizeof folds, callers, sizeof folds);")

# base

m("output-not-renamed", "rename left out", "file, cli_output",
  "if (count == 1 && ffd_place(files->temporary, files->target, files->replace) != 0)",
  "if (count == 1 && ffd_place(files->temporary, files->temporary, true) != 0)")
m("link-to-nothing-is-a-file", "check left out", "file, cli_output",
  "if (S_ISLNK(info->st_mode) && stat(path, info) != 0) {", "if (S_ISLNK(info->st_mode) && stat(path, info) > 0) {")
m("appearing-output-replaced", "race", "file, cli_siege", ".replace = file->force}", ".replace = true}")
m("head-set-aside-last", "order", "file_set, cli_file_sets", "for (size_t i = record->count; i-- > 0;) {",
  "for (size_t i = 0; i < record->count; i++) {")
m("set-not-undone", "clean-up left out", "file_set, cli_file_sets", "if (settle(record, false, NULL)) tell_of_record(record, error);",
  "if (!record) tell_of_record(record, error);",
  "if (settle(record, NULL)) tell_of_record(record, error);", "if (!record) tell_of_record(record, error);")
m("placed-set-judged-by-a-look", "race", "cli_file_sets", "if (!status) return settle(record, true, error);",
  "if (!status)\n        return settle(record, has_head(record), error);")
m("killed-set-not-restored", "recovery left out", "file_set, cli_file_sets",
  "if (!status && record.fd >= 0) status = settle(&record, has_head(&record), error);",
  "if (!status && record.fd >= 1000000)\n        status = settle(&record, has_head(&record), error);",
  "if (!status && record.fd >= 0) status = settle(&record, error);",
  "if (!status && record.fd >= 1000000)\n        status = settle(&record, error);")
m("pipe-as-module", "check left out", "cli_modules", "!S_ISREG(file.st_mode) || file.st_mode & S_IWOTH",
  "file.st_mode & S_IWOTH")
m("copies-not-compared", "check left out", "cli_batch_outputs",
  "if (is_copy && !is_same_copy(files->copied[number].source, source))", "if (is_copy && files->copied[number].line == 0)")
m("record-of-others-trusted", "owner check left out", "cli_file_sets", "if (info.st_mode & 022 || info.st_nlink != 1 ||",
  "if (info.st_mode & 010000000 ||")
m("cut-input-not-noted", "error left out", "mapping, cli_cut_inputs", "atomic_store(&mapping->is_cut, true);",
  "atomic_store(&mapping->is_cut, false);")
m("shorter-input-not-seen", "error left out", "mapping", "(uintmax_t)info.st_size < atomic_load(&mapping->size)",
  "(uintmax_t)info.st_size > atomic_load(&mapping->size)")
m("close-not-checked", "close check left out", "file, cli_full_disk, cli_output",
  "(twin < 0 || close(twin) != 0)", "(twin < 0 || (close(twin) != 0 && twin < 0))")
m("output-not-locked", "lock left out", "file, cli_output, cli_batch_signals",
  "if (flock(fd, LOCK_EX | LOCK_NB) != 0 && !has_no_locks())", "if (flock(fd, LOCK_UN) != 0 && !has_no_locks())")
m("block-overrun", "bound", "file, cli_output",
  "size > BLOCK - output->filled ? make_room(output, error)", "size > BLOCK ? make_room(output, error)")
m("mode-not-kept", "file mode", "file, cli_output", "old->st_mode & 0777", "old->st_mode & 0666")
m("output-left-open", "freed resource", "file, cli_many", "if (file->fd >= 0) close(file->fd);",
  "if (file->fd >= 1000000)\n            close(file->fd);")
m("leftover-not-removed", "clean-up left out", "file, cli_output, cli_full_disk",
  "if (file->temporary && !file->committed) remove_temporary(file);",
  "if (file->temporary && file->committed) remove_temporary(file);")
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
  "if (text[0] < 0x20 || text[0] == 0x7f)", "if (text[0] < 0x20 && text[0] == 0x7f)")
m("c1-characters-shown", "message", "cli_stays_behind, cli_tears", "text[1] >= 0x80 && text[1] <= 0x9f", "text[1] >= 0x80 && text[1] <= 0x80")
m("cut-parts-in-a-character", "cut", "cli_tears", "ffd_name_shown(text, name + begun, capacity - begun);", "snprintf(name + begun, capacity - begun, \"%s\", text);")
m("check-counts-other-targets", "call left out", "cli_as_morph", "job->document->keeps_base = true;", "job->document->keeps_base = false;")
m("new-weight-behind-others", "place", "cli_as_morph", "tree->values[weights].count > targets)", "tree->values[weights].count > targets + 9)")
m("skins-elsewhere-left", "call left out", "cli_rig", "if (shown[s] || (staying[s] && ffd_gltf_has_joint_matrices(d, skin)))", "if (shown[s])")
m("shown-by-other-weights", "check left out", "cli_morph_weights", "same_influences(part, wanted) && shown_alike(d, part, wanted, GLTF_POSITION))", "same_influences(part, wanted))")
m("parts-in-the-order-of-files", "order", "cli_view", "return a->owner < b->owner ? -1 : 1;", "return 0;")
m("long-names-alike", "limit", "cli_aliases",
  "1 + length + strlen(ending) <= LONGEST_NAME", "1 + length + strlen(ending) <= 2 * LONGEST_NAME")
m("hash-of-doubles", "stride", "embedding_file, base", "store_double(bytes + 8 * i, values[done + i]);",
  "store_double(bytes + 8 * i, values[i]);")
m("ties-of-decimals", "rounding", "number",
  "const uint64_t nearest = whole + (part + (whole & 1) > unit / 2);",
  "const uint64_t nearest = whole + (part > unit / 2);")
m("tie-of-a-quotient", "rounding", "charconv, number", "number += low > half || (low == half && (number & 1));",
  "number += low > half || low == half;")
m("rest-of-a-quotient", "rounding", "charconv", "round_to(quotient | (quotient * power != scaled),", "round_to(quotient,")
m("digits-cut-off", "rounding", "charconv, number", "return !text->is_cut || (round_whole(", "return true || (round_whole(")
m("halfway-between-floats", "rounding", "charconv, number", "if (!end || is_halfway(parsed))",
  "if (!end || (is_halfway(parsed) && end == first))")
m("neighbour-of-a-power", "rounding", "charconv", "if (is_power_of_two && step_up(digits)",
  "if (is_power_of_two && count < 0 && step_up(digits)")
m("digits-of-tiny-numbers", "rounding", "charconv, number", "return whole + (part + (whole & 1) > unit / 2);",
  "return whole + (part > unit);")
m("module-of-another-version", "check left out", "cli_modules",
  "strcmp(found->version, wanted->version) == 0 &&", "")
m("module-of-another-name", "check left out", "cli_modules", "strcmp(found->file, wanted->file) == 0 &&", "")
m("module-without-memory", "error code", "cli_modules", "if (!has_memory(MODULE_BYTES)) return ffd_fail_memory(error);", "",
  "if (!has_room(MODULE_BYTES)) return ffd_fail_memory(error);", "")
m("modules-of-the-working-folder", "path", "cli_modules", "snprintf(tried, LONGEST_PATH, \"%s%s%s/%s\", is_absolute ? \"\" : own,",
  "snprintf(tried, LONGEST_PATH, \"%s%s%s/%s\", is_absolute ? \"\" : \".\",")
m("module-of-another-user", "check left out", "cli_modules", "return has_link && has_file;", "return has_link || file.st_size >= 0;")
m("meshopt-without-its-module", "check left out", "cli_modules", "if (status == FFD_OK) status = ffd_meshopt_ready(view, &problem);", "")
m("sine-of-45", "rounding", "trig", "if (size == 45)", "if (size == 46)")
m("utf8-surrogates", "check left out", "base, json_span", "(first == 0xed && c[1] > 0x9f)",
  "(first == 0xed && c[1] > 0xbf)",
  "*code > 0x10ffff || (*code >= 0xd800 && *code <= 0xdfff)", "*code > 0x10ffff")
m("null-for-infinity", "format", "base", "if (isfinite(value)) ffd_buffer_number(json->out, value);",
  "if (!isnan(value))\n        ffd_buffer_number(json->out, value);")
m("processors-of-the-machine", "limit left out", "processors, cli_ops", "return CPU_COUNT_S(count * sizeof *sets, sets);",
  "return count_online();")
m("quota-left-out", "limit left out", "cli_processors", "limit = allowed > 1 ? count_limit() : 1;", "limit = allowed > 1 && count_limit() > 0 ? INT_MAX : 1;")
m("quota-rounded-down", "rounding", "processors, cli_processors", "return quota / period + (quota % period != 0);",
  "return quota < period ? 1 : quota / period;")
m("limits-above-the-cgroup", "loop", "processors, cli_processors", "if (!slash || (size_t)(slash - in->folder) < in->top)",
  "if (slash || (size_t)(slash - in->folder) < in->top)")

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
  "faces_meet(lattice, FFD_VOLUME_REST, direction, 16, false)", "faces_meet(lattice, FFD_VOLUME_REST, direction, 0, false)",
  "tolerance[a] = 16 * DBL_EPSILON * most;", "tolerance[a] = 0 * most;",
  "tolerance[a] = 16 * DBL_EPSILON * extent;", "tolerance[a] = 0 * extent;")
m("rotation", "sign", "moves, oracle moves", "+ ready->sine * f[c];", "- ready->sine * f[c];")
m("within-slack", "tolerance", "moves, oracle moves", "x[c] >= move->within_min[c] - work->slack[c]",
  "x[c] >= move->within_min[c]")
m("difference-of-by", "sum", "cli_translation", "difference[c] += by;", "difference[c] = p[c] - rest[c];",
  "*difference += move->weight * move->vector[c];", "*difference = *p - rest;")
m("pull-profile", "exponent", "soft_moves, cli_moves", "return x < 1 ? (1 - x * x) * (1 - x * x) : 0;",
  "return x < 1 ? 1 - x * x : 0;")
m("pull-of-the-moved-place", "place", "soft_moves, cli_moves", "const double weight = weight_at(work, move, from_rest);",
  "const double weight = weight_at(work, move, from);")
m("falloff-curve", "formula", "soft_moves, cli_moves", "return x < 1 ? 1 - x * x * (3 - 2 * x) : 0;", "return x < 1 ? 1 - x : 0;")
m("falloff-of-the-region", "unit", "soft_moves", "/ (work->box_units ? extent : 1);", "/ (extent > 0 ? 1 : 1);")
m("falloff-not-mirrored", "reflection left out", "soft_moves, cli_moves", "ffd_mirror_point(plane, rest, from_rest);",
  "from_rest[0] = rest[0];")
m("mirrored-by", "sign", "soft_moves, cli_moves", "const double by = weight * (reflected ? -move->vector[c] : move->vector[c]);",
  "const double by = weight * move->vector[c];")
m("mirror-far-side", "search cut short", "soft_moves", "const bool found = is_near(look->offset) &&",
  "const bool found = look->offset[c] < 0 &&")
m("mirror-tree-middle", "point left out", "soft_moves", "if (is_at(look, middle) || (before ?", "if ((before ?")
m("mirror-rounding", "tolerance", "soft_moves", "+ 16 * DBL_EPSILON * size; return (mirror_plane)", "+ 0 * size;\n    return (mirror_plane)")
m("mirror-image-missing", "check left out", "soft_moves, cli_lattice_schema", "if (selected[i] && !has_image(all, plane, i))",
  "if (selected[i] && !has_image(all, plane, i) && i > lattice->count)")
m("mirror-not-written", "member left out", "lattice_file", "if (spec->moves[i].has_mirror) write_mirror",
  "if (spec->moves[i].has_mirror && i > spec->move_count) write_mirror")
m("exact-bend-weights", "product", "exact_bend", "lattice->deformed_weights[point] *= cosine_of_half;",
  "lattice->deformed_weights[point] = cosine_of_half;")
m("exact-bend-tangents", "formula", "exact_bend, cli_moves", "more = 2 * sine * sine / cosine_of_half;", "more = 2 * sine * sine;")
m("exact-bend-of-half-a-turn", "limit", "exact_bend", "if (degrees < 180)", "if (degrees <= 180)")
m("exact-bend-of-tapered-rows", "check left out", "exact_bend", "if (!(vec_length(away) <= a->slack))", "if (!(vec_length(away) <= INFINITY))")
m("exact-bend-of-half-arcs", "check left out", "exact_bend", "if (a->first % 2 == 0 && a->last % 2 == 0)", "if (a->first <= a->last)")
m("exact-bend-fades", "check left out", "exact_bend, cli_lattice_schema", "(move->weight == 1 && move->falloff.kind == FALLOFF_NONE)",
  "move->weight == 1")
m("bend-of-small-angles", "rounding", "moves, oracle moves",
  "cosine > 0.5 ? 2 * half_sine * half_sine : 1 - cosine", "cosine > 2 ? 2 * half_sine * half_sine : 1 - cosine")
m("weight-of-zero", "limit", "lattice_file, cli_errors", "!status && !((*weights)[i] > 0)",
  "!status && !((*weights)[i] >= 0)")
m("cylinder-margin", "factor", "shapes, cli_lattice_new",
  "fmax(radius * (1 + 2 * desc->margin[0])", "fmax(radius * (1 + desc->margin[0])", "radius * (1 + 2 * desc->margin)",
  "radius * (1 + desc->margin)")
m("margins-of-a-cylinder", "left out", "shapes", "desc->margin[1] != desc->margin[2]", "desc->margin[0] != desc->margin[1]")
m("hint-of-another-word", "operand", "cli_lattice_comments", '{"offset", "by"}', '{"offset", "to"}')
m("misplaced-key", "left out", "cli_lattice_comments", "ffd_status status = refuse_misplaced(box);",
  "ffd_status status = box.file ? FFD_OK : refuse_misplaced(box);")
m("lattice-member", "member name", "lattice_file, shapes, cli_lattice_new", '"height", spec->height',
  '"radius", spec->height')

m("extent-of-the-last-lowest", "tie", "tangents", "first = s.v < first.v ? s : first;", "first = s.v <= first.v + 1 ? s : first;")
m("weight-without-its-derivative", "term left out", "tangents", "made->weight = (dual){m->weight, d->weight};", "made->weight = (dual){m->weight, 0};")
m("image-not-reflected", "sign", "tangents", "derivative[c] = plane && c == plane->axis ? -moved.c[c].d : moved.c[c].d;", "derivative[c] = moved.c[c].d;")
m("exact-weights-not-followed", "term left out", "tangents", "*d = dual_mul((dual){weights ? weights[point] : 1, *d}, cosine).d;", "*d = dual_mul((dual){weights ? weights[point] : 1, *d}, (dual){cosine.v, 0}).d;")
m("rows-not-faded", "factor left out", "cli_jacobian, points", "fill_row(embedding->rest, weights, nearest->uvw, fade, row);", "fill_row(embedding->rest, weights, nearest->uvw, 1, row);",
  "ffd_basis_row_at(embedding->rest, weights, nearest->uvw, fade, row);", "ffd_basis_row_at(embedding->rest, weights, nearest->uvw, 1, row);")
m("later-lattice-forgotten", "factor left out", "cli_jacobian", "return later ? later : inverse ? inverse : identity;", "return inverse ? inverse : identity;")
m("columns-by-how-names-begin", "comparison", "cli_jacobian", "if (strcmp(j->names[*column], name) == 0)", "if (strncmp(j->names[*column], name, 150) == 0)")
m("size-of-a-result-not-checked", "check left out", "older_callers", "if (!status && callers_result) status = ffd_struct_check(sizeof result, callers_result, \"ffd_jacobian_result\", &own);", "")
m("zip-checksum", "operation", "cli_jacobian", "member->crc = crc_of(member->crc, bytes, size);", "member->crc = crc_of(0, bytes, size);")
m("invalid-point-converted", "condition", "points", "if (!invalid || work->in.type != work->out.type)", "if (work->out.data)")
m("arrays-of-another-lattice", "check left out", "points", "if (memcmp(a->rest, b->rest, 3 * size) != 0)", "if (memcmp(a->rest, b->rest, size) > 1000)")
m("older-struct-overrun", "bound", "points", "memcpy(callers, own, size < own_size ? size : own_size);", "memcpy(callers, own, own_size);")

m("offsets-by-difference", "cancellation", "cli_parameters", "memcpy(lattice->difference, spec->deformed_offsets, size);",
  "memcpy(lattice->difference, lattice->difference, size);")
m("minus-forgotten", "sign", "cli_parameters", "placeholder->factor = -placeholder->factor;", "placeholder->factor = +placeholder->factor;")
m("default-outside-its-bounds", "check left out", "cli_lattice_schema",
  "if (find_outside(cursor.tree, cursor.value, parameter, &number))", "if (find_outside(cursor.tree, cursor.value, parameter, &number) && number == 0.25)")
m("max-not-included", "bound", "cli_parameters", "*number <= parameter->max", "*number < parameter->max")
m("product-of-infinity", "check left out", "cli_parameters", "&& isfinite(factor * number);", "&& !isnan(factor * number);")

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
m("alike-on-a-face", "bound", "cli_translation", "while (absent < degree && t[-absent] == t[0])",
  "while (absent + 1 < degree && t[-absent] == t[0])")
m("kept-cell-of-another", "check left out", "displacement, deform", "if (kept->keys[slot] == cell->key + 1)",
  "if (kept->keys[slot] != 0)")
m("fade-slope", "sign", "extension", "*slope = -30 * (s * s) * (rest * rest) / falloff;",
  "*slope = 30 * (s * s) * (rest * rest) / falloff;")
m("lanes-of-tangents", "kernel", "attribute_batch", "const lanes along = lanes_dot(carried, normal);",
  "const lanes along = lanes_dot(tangent, normal);")

# splat

m("splat-sizes", "operation", "splat, cli_splats", "lengths[order[i]] / work->parts[order[i]]", "lengths[order[i]] * work->parts[order[i]]")
m("splat-axes-as-they-come", "check left out", "splat, cli_splats", "for (int o = 0; o < (is_flat ? 2 : 6); o++) { double signs[3];",
  "for (int o = 0; o < (is_flat ? 2 : 1); o++) {\n        double signs[3];")
m("splat-axes-left-handed", "condition", "splat, cli_splats", "is_right = is_right == (cosine >= 0);", "is_right = is_right && cosine < 2;")
m("splat-quaternion-length", "operation", "splat, cli_splats", "(along < 0 ? -length : length) * made[i]", "(along < 0 ? -1 : 1) * made[i]")
m("splat-quaternion-sign", "sign", "cli_splats", "(along < 0 ? -length : length) * made[i]", "length * made[i]")
m("splat-mirrored", "condition", "splat, cli_splats", "turn->is_mirrored = vec_dot(f, cofactor) < 0;",
  "turn->is_mirrored = vec_dot(f, cofactor) < -1e300;")
m("splat-turn-of-a-plane", "left out", "splat", "f[i] += cofactor[i] / size;", "f[i] += 0 * cofactor[i] / size;")
m("splat-frame", "transposition", "splat, cli_splats",
  "axes[r] * product[c] + axes[3 + r] * product[3 + c] + axes[6 + r] * product[6 + c]",
  "axes[3 * r] * product[c] + axes[3 * r + 1] * product[3 + c] + axes[3 * r + 2] * product[6 + c]")
m("splat-jacobi-ends", "loop", "splat, cli_splats", "bool any = true; for (int sweep = 0; sweep < SWEEPS && any; sweep++) { any = rotate(columns, columns + 3);",
  "bool any = true;\n    for (int sweep = 0; sweep < 1 && any; sweep++) {\n        any = rotate(columns, columns + 3);")
m("splat-round-axes", "tolerance", "cli_splats", "#define RIGHT 1e-12", "#define RIGHT 1e-17")
m("splat-flattened", "figure", "splat, cli_splats", "*outcome = work->is_flattened ? SPLAT_FLATTENED : SPLAT_CARRIED;",
  "*outcome = SPLAT_CARRIED;")
m("harmonics-lobe", "sign", "splat, cli_splats", "{4, 1, 1.7975962960832887629}", "{4, 1, -1.7975962960832887629}")
m("harmonics-odd-mirrored", "condition", "splat, cli_splats", "if (turn->is_mirrored && degree >= 3)",
  "if (turn->is_mirrored && degree > 3)")
m("logarithm-terms", "bound", "splat", "for (int i = ARTANH_TERMS; i-- > 0;) sum = square * (artanh[i] + sum); return exponent * LN2_HIGH + (2 * (z",
  "for (int i = 5; i-- > 0;)\n        sum = square * (artanh[i] + sum);\n    return exponent * LN2_HIGH + (2 * (z")
m("splat-lanes-that-rest", "figure", "splat", "is_still[l] ? SPLAT_KEPT : SPLAT_CARRIED", "SPLAT_CARRIED")
m("splat-lanes-second-axis", "order", "splat", "lanes_choose(order == 1.0, values[step], values[2 * step])",
  "lanes_choose(order == 2.0, values[step], values[2 * step])")
m("splat-lanes-weakest", "mask", "splat", "lanes_choose(~is_right & weakest[i], -signs[i], signs[i])",
  "lanes_choose(is_right & weakest[i], -signs[i], signs[i])")
m("splat-lanes-disks", "condition", "splat", "o < (is_flat ? 2 : 6); o++) try_order", "o < (is_flat ? 3 : 6); o++)\n        try_order")
m("splat-lanes-mirrored", "mask", "splat", "at.f[i] = lanes_choose(is_mirrored, -at.f[i], at.f[i]);", "at.f[i] = +at.f[i];")
m("splat-lanes-flattened", "left out", "splat", "at.is_usable & (at.is_still | ((lanes_largest_entry(at.f) >= LEAST_F) & ~at.is_flattening))",
  "at.is_usable & (at.is_still | (lanes_largest_entry(at.f) >= LEAST_F))",
  "at.is_usable & (at.is_still | ((largest_entry(at.f) >= LEAST_F) & ~at.is_flattening))",
  "at.is_usable & (at.is_still | (largest_entry(at.f) >= LEAST_F))")
m("logarithm-lanes-halved", "sign", "splat", "exponents - is_large + whole", "exponents + is_large + whole")

m("polar-lanes-go-on", "mask", "splat", "x[i] = lanes_choose(is_open, next, x[i]);", "x[i] = next;")
m("columns-lanes-that-rest", "mask", "splat", "p[k] = lanes_choose(turns, c * x - s * y, x);", "p[k] = c * x - s * y;")
m("harmonics-rest-of-a-run", "left out", "splat, cli_splats", "kernel ? kernel(rotations, degree, some, c + first) : 0; i < some; i++)",
  "kernel ? kernel(rotations, degree, some, c + first) + 1 : 0; i < some; i++)")

# embed

m("separable-stride", "stride", "locator", "a == 1 ? lattice->size[0] : lattice->size[0] * lattice->size[1];",
  "a == 1 ? lattice->size[0] : lattice->size[1] * lattice->size[1];")
m("separable-tolerance", "tolerance", "locator, oracle embedding", "p[a] < fmin(first, last) - tolerance[a]",
  "p[a] < fmin(first, last) + tolerance[a]")
m("roots-across-seam", "seam", "locator, oracle embedding",
  "side_of(locator, direction) - apart : apart;", "side_of(locator, direction) : apart;",
  "apart = side_of(locator, d) - apart;", "apart = side_of(locator, d);")
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
m("stalled-point-searched-once", "condition", "border_cells",
  "location->status == FFD_SINGULAR && location->unresolved && search->blurred", "location->status == FFD_SINGULAR && search->strict")
m("sliver-never-doubtful", "condition", "border_cells", "search->doubtful = true;", "search->doubtful = false;")
m("further-search-leaves-by-an-estimate", "condition", "border_cells",
  "if (surely ? !is_far : !(out > bend) ||", "if (!(out > bend) ||")
m("image-without-the-tolerance", "bound", "border_cells", "if (fabs(off) > reach + rounding +", "if (fabs(off) > rounding +")
m("plane-in-the-cell", "bound", "border_cells", "return least > reach || most < -reach;",
  "return least > 0.5 * reach || most < -0.5 * reach;")
m("plane-behind-the-cell", "bound", "border_cells", "return least > reach || most < -reach;",
  "return least > 1.01 * reach || most < -1.01 * reach;")
m("patch-not-halved", "step left out", "border_cells", "if (view != PATCH_UNKNOWN) return FFD_OK;",
  "if (view != PATCH_UNKNOWN || patch->order[0] > 0)\n        return FFD_OK;")
m("cell-not-scaled", "wrong space", "border_cells", "cell.half[a] = each[a] / query.unit;", "cell.half[a] = each[a];")

# fold

m("laplace-sign", "sign", "fold, oracle folds", "pair_sign[6] = {1, -1, 1, 1, -1, 1};",
  "pair_sign[6] = {1, -1, 1, 1, 1, 1};")
m("zeros-of-two-coordinates", "bound", "fold, oracle folds",
  "for (size_t r = 0; r < 3; r++) if (points[3 * i + r] != points[3 * j + r]) return false; return !weights",
  "for (size_t r = 0; r < 2; r++)\n        if (points[3 * i + r] != points[3 * j + r])\n            return false;\n"
  "    return !weights")
m("volume-of-faces", "sign", "fold, oracle folds", "const double sign = end ? 1 : -1; ffd_face_net_fill",
  "const double sign = end ? -1 : 1;\n    ffd_face_net_fill")
m("witness-in-the-cell", "bound", "oracle folds", "uvw[a] = is_last ? knot[1] : nextafter(knot[1], knot[0]);",
  "uvw[a] = is_last ? knot[0] : nextafter(knot[1], knot[0]);")
m("witness-not-looked-at", "step left out", "cli_fold_exact", "if (place.sign > 0) return; folds->", "folds->")
m("mirror-as-affine-map", "condition", "cli_fold_exact", "return loss <= 0.5 && *determinant > 0;", "return loss <= 0.5;")
m("affine-beside-weights", "condition", "cli_fold_exact", "if (!(fabs(deformed[i] / rest[i] - factor) <= 4 * DBL_EPSILON * factor))",
  "if (deformed[i] / rest[i] < 0)")
m("rule-without-weights", "bound", "rational_volume", "const double room = 1 - q * weight;", "const double room = 1 + 0 * q * weight;")
m("limbs-of-a-product", "off by one", "wide", "a->exponent + b->exponent + 1, product", "a->exponent + b->exponent, product")
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
m("fine-positions", "tolerance", "model, cli_convert", "#define SHAPE_TOLERANCE 0x1p-17",
  "#define SHAPE_TOLERANCE 0x1p-9")
m("boxes-cleared-from-the-near-side", "bound", "polygon_cut", "const double y = dx > 0 ? node->high[1] : node->low[1]", "const double y = dx > 0 ? node->low[1] : node->high[1]")
m("all-corners-looked-at", "speed", "polygon_cut", "cutter->has_boxes = !is_plain;", "cutter->has_boxes = false;")
m("polygon-seen-from-below", "sign", "polygon_cut, cli_convert", "(axis + (normal[axis] < 0 ? 2 : 1)) % 3",
  "(axis + (normal[axis] > 0 ? 2 : 1)) % 3")
m("reflex-angle", "operation", "normals, cli_normals", "ffd_arc_tangent(0, -1) * 2 - angle : angle;",
  "ffd_arc_tangent(0, -1) - angle : angle;")

m("copy-through-a-link", "check left out", "cli_hostile_inputs, cli_materials", "if (is_through_link(c->from, resource->path))",
  "if (!c->from && is_through_link(c->from, resource->path))")
m("copy-of-a-hidden-file", "check left out", "cli_hostile_inputs, cli_materials", "if (ffd_image_is_hidden(resource->path))",
  "if (!source && ffd_image_is_hidden(resource->path))")
m("copy-by-its-name", "check left out", "cli_hostile_inputs, cli_materials",
  "return resource->kind->has_content(bytes->data, bytes->size) ? NULL", "return bytes->size ? NULL")
m("copy-by-its-content", "check left out", "cli_hostile_inputs, cli_materials",
  "if (!resource->kind->has_name(resource->path))", "if (!resource->kind->has_name(resource->path) && !source)")
m("copy-over-another", "check left out", "gltf_save, cli_materials",
  "const ffd_status status = ffd_file_compare(target, bytes, &same, error); if (status || same)",
  "const ffd_status status = ffd_file_compare(target, bytes, &same, error);\n    if (status || !same)")
m("copy-out-of-the-folder", "check left out", "gltf_save, cli_materials", "*left = NULL; if (ffd_path_leads_out(resource->path)) {",
  "*left = NULL;\n    if (ffd_path_leads_out(resource->path) && !c->mesh) {")
m("output-over-a-copy", "check left out", "gltf_save", "strcmp(resource->path, ffd_path_name(target)) == 0",
  "strcmp(resource->path, target) == 0")
m("image-loaded-twice", "cache left out", "materials", "*image = images->numbers[number]; else",
  "*image = MATERIAL_LOST;\n    else")
m("images-not-in-the-budget", "limit", "materials", "ffd_budget_take(images->budget, 1, all, &problem)",
  "ffd_budget_take(images->budget, 0, all, &problem)")
m("other-images-kept", "check left out", "materials", "if (!is_shown(bytes, size)) {", "if (!is_shown(bytes, size) && size < 4) {")
m("fourth-image-said", "message", "materials", "for (size_t i = 0; i < LEFT_SHOWN && i < left->count; i++)",
  "for (size_t i = 0; i + 1 < LEFT_SHOWN && i < left->count; i++)")
m("colours-beyond-one", "check left out", "materials", "return number >= 0 && number <= 1 ? number : 1;",
  "return number >= 0 ? number : 1;")
m("image-left-behind", "freed resource", "materials", "ffd_free(materials->images); *materials = (mesh_materials){0};",
  "ffd_free(materials->images);")

m("lower-bound-of-another-half", "bound", "base", "if (before((const char *)elements + middle * size, key)) low = middle + 1;",
  "if (before((const char *)elements + middle * size, key)) low = middle + 2;")
m("last-element-never-found", "bound", "base, knots", "size_t low = 0, high = count; while (high - low > 1) {",
  "size_t low = 0, high = count; while (high - low > 2) {")

# picture

m("edges-of-neither", "fill rule", "picture_raster", "const bool is_own = dy < 0 || (dy == 0 && dx > 0);", "const bool is_own = dy < 0 && dx != 0;")
m("edges-of-both", "fill rule", "picture_raster", "return (edge){from->x, from->y, dx, dy, is_own ? 0 : -1};",
  "return (edge){from->x, from->y, dx, dy, is_own ? 0 : 0};")
m("large-edges-in-32-bits", "overflow", "picture_raster", "s->is_small = size < SMALL;", "s->is_small = size < 64 * SMALL;")
m("samples-at-the-border-forgotten", "bound", "picture_raster", "*last = (high - SAMPLE_MARGIN) >> 8;", "*last = (high - 2 * SAMPLE_MARGIN) >> 8;")
m("repeats-of-another-material", "check left out", "picture_raster",
  "turn < 3 && ffd_shade_material(of->mesh, other) == material &&", "turn < 3 &&")
m("repeats-from-one-corner-only", "speed", "picture_raster", "while (turn < 3 &&", "turn = t[0] == other[0] ? 0 : 3; while (turn < 3 &&")
m("repeats-with-holes-elsewhere", "check left out", "picture_raster", "(!has_holes || has_same_holes(of, triangle, other, turn))", "true")
m("holes-compared-unturned", "index", "picture_raster", "there + 2 * ((turn + k) % 3)", "there + 2 * k")
m("blocks-nearer-than-they-are", "bound", "picture_raster",
  "s->z_across * (s->z_across > 0 ? left : right)", "s->z_across * (s->z_across > 0 ? right : left)")
m("blocks-cut-at-an-edge", "bound", "picture_raster, picture",
  "const int64_t y = e->dx > 0 ? bottom : top, x = e->dy > 0 ? left : right;", "const int64_t y = e->dx > 0 ? top : bottom, x = e->dy > 0 ? left : right;")
m("last-drawn-in-front", "depth", "picture_raster, picture", "const numbers drawn = inside & (at < there);", "const numbers drawn = inside & (at <= there);")
m("far-plane-not-cut", "clipping", "picture_raster", "to->points[to->count][axis] = sign * GUARD;", "to->points[to->count][axis] = GUARD;")
m("back-drawn-too", "culling", "picture_raster", "if (side && !ffd_shade_material(of->mesh, triangle)->is_double_sided)",
  "if (side && ffd_shade_material(of->mesh, triangle)->alpha_cutoff > 9)")
m("seam-in-the-light", "normals", "picture", "return mesh->twins ? mesh->twins[vertex] : vertex;", "return mesh->twins && vertex == 0 ? mesh->twins[vertex] : vertex;")
m("no-creases", "normals", "picture", "#define MEAN_SQUARE 0.75", "#define MEAN_SQUARE 0.05")
m("levels-not-chosen", "texture", "picture", "while (level + 1 < of->level_count && size >= 2 * step)", "while (level + 1 < of->level_count && size >= 1e9 * step)")
m("mirror-as-repeat", "texture", "picture", "return x > 1 ? 2 - x : x;", "return x > 1 ? x - 1 : x;")
m("transparent-colour-bleeds", "texture", "picture", "alpha ? sum[c] / alpha : plain[c] / count", "alpha ? plain[c] / count : plain[c] / count")
m("left-is-right", "camera", "picture", "{\"left\", -90, 0}", "{\"left\", 90, 0}")
m("fit-to-one-side", "camera", "picture", "scale = lesser_of(across, upwards);", "scale = larger_of(across, upwards);")
m("hidden-lines-as-others", "depth", "picture", "strength * (seen + (1 - seen) * with->hidden)", "strength * (seen + (1 - seen))")
m("crease-memory-not-counted", "limit", "picture", "budget ? ffd_budget_check(budget, total, SPLIT_BYTES, error) : FFD_OK",
  "budget ? ffd_budget_check(budget, total, 1, error) : FFD_OK")
m("image-size-not-checked", "limit", "picture_image", "return budget ? ffd_budget_check(budget, width * height, bytes_a_pixel, error) : FFD_OK;",
  "return budget ? ffd_budget_check(budget, width, bytes_a_pixel, error) : FFD_OK;")
m("coefficients-not-counted", "limit", "picture_image", "jpeg_has_multiple_scans(jpeg) ? COEFFICIENT_BYTES", "jpeg_has_multiple_scans(jpeg) ? 0")
m("cut-jpeg-taken", "error left out", "picture_image", "if (jpeg->err->msg_code == failures[i])", "if (jpeg->err->msg_code == -failures[i])")
m("end-of-png-not-read", "error left out", "picture_image", "png_read_end(png, NULL);", "png_set_crc_action(png, PNG_CRC_DEFAULT, PNG_CRC_DEFAULT);")
m("lattice-as-large-as-it-is", "bound", "cli_view", "#define REACH 2.0", "#define REACH 1e9")
m("panels-all-kept", "freed resource", "view", "view_palette own;\n    free_step(w);", "view_palette own;")
m("lost-image-in-its-colour", "check left out", "cli_view", "const bool is_lost = from->image == MATERIAL_LOST || (of && of->level_count == 0);",
  "const bool is_lost = of && of->level_count == 0;")
m("size-of-a-page", "check left out", "cli_view", "if (is_page && s->size[0])", "if (is_page && s->size[0] > 40000)")
m("own-texture-replaced", "check left out", "cli_view", "is_named = ffd_file_same(files.paths[i], output);", "is_named = false;")
m("other-spelling-of-out", "check left out", "cli_output", "const bool meet = here && there && (strcmp(here, there) == 0 || ffd_file_same(here, there));",
  "const bool meet = here && there && strcmp(a, b) == 0;")

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
  "return next == scan->last || ffd_obj_class(next) == OBJ_LINE_END;",
  "return next + 1 == scan->last || ffd_obj_class(next) == OBJ_LINE_END;")
m("greatest-element", "off by one", "obj_users, obj", "*greatest = *greatest > element ? *greatest : element + 1;",
  "*greatest = *greatest > element ? *greatest : element;")
m("corner-run-of-a-longer-index", "bound", "obj_users, obj", "(unsigned)normal - 1 >= 8)", "(unsigned)normal - 1 >= 9)")
m("corner-run-without-a-slash", "check left out", "obj_users, obj, cli_obj", "text[other_slash] != '/' ||", "")
m("first-normal-replaced", "check left out", "obj_users, obj_normals", "if (there == 0 && is_alone) {", "if (is_alone) {")
m("libraries-not-seen", "condition", "obj_resources, cli_materials", "(!input->mapped && !names_files && !ffd_obj_names_libraries(input)) ||",
  "!input->mapped ||")
m("block-cut-in-a-line", "bound", "obj_blocks", "if (!may_continue(first, end)) return at; at--;",
  "if (!may_continue(first, end) || at < last)\n            return at;\n        at--;")
m("digits-of-a-number", "bound", "obj, number, bytes", "count < 1 || count > 16)", "count < 1 || count > 17)")

m("one-library-of-two-words", "check left out", "cli_materials", "if (is_file(path, text, size)) return ffd_obj_add_name",
  "if (size > NAME_MAX_SIZE && is_file(path, text, size))\n        return ffd_obj_add_name")
m("library-of-a-continued-line", "check left out", "obj_resources", "return !is_continued(first, at);",
  "return !is_continued(first, at) || at > first;")
m("library-across-pieces", "bound", "obj_resources", "if (begins_statement(first, at, last, keyword)) return at;",
  "if (begins_statement(first, at, end, keyword))\n            return at;")
m("words-of-an-option", "wrong constant", "obj_resources, cli_materials", '{"-mm", 2, false}', '{"-mm", 1, false}')
m("map-beside-the-mesh", "condition", "materials, cli_materials", "if (status || !*path || is_there(folder, *path)) return status;",
  "if (status || !*path || !is_there(folder, *path))\n        return status;", "if (!is_there(c, path)) status = find_path(",
  "if (is_there(c, path))\n        status = find_path(")
m("library-of-any-text", "check left out", "obj_resources, cli_materials", 'return ffd_text_is_any_case(word, "newmtl");',
  "return word.first < word.last;")
m("library-of-zeros", "check left out", "obj_resources, cli_materials", "if (memchr(bytes, 0, size)) return false;",
  "if (memchr(bytes, 0, text / 2))\n        return false;")
m("output-over-a-library", "check left out", "cli_materials", "!is_stay || ffd_mtl_has_name(options->path) ||",
  "!is_stay ||")
m("library-that-is-reached", "message", "cli_materials", "if (ffd_path_leads_out(resource->path) && is_reached(c, resource->path))",
  "if (ffd_path_leads_out(resource->path) && !c->from)")
m("libraries-of-an-input", "condition", "cli_materials, cli_batch_neighbours",
  "return ffd_format_table(format) == ffd_format_table(from_format) &&", "return ffd_format_table(format) != ffd_format_table(from_format) &&")
m("many-maps", "limit", "cli_materials", "if (names->count > OBJ_RESOURCES_MAX)", "if (names->count > OBJ_RESOURCES_MAX + 1)")
m("last-definition-of-a-material", "order", "materials", "d->counts = number == known; if (!d->counts)",
  "d->counts = true;\n    if (number != known)")
m("colours-of-libraries-linear", "term left out", "materials", "has_map && is_black ? 1 : ffd_srgb_to_linear(d->diffuse[c])",
  "has_map && is_black ? 1 : d->diffuse[c]")
m("black-under-a-map", "condition", "materials", "has_map && is_black ? 1 :", "has_map && !is_black ? 1 :")
m("opacity-turned", "sign", "materials", "d->has_opacity ? d->opacity : 1 - d->clearness", "d->has_opacity ? d->opacity : d->clearness")
m("clearness-over-opacity", "order", "materials", "d->has_opacity ? d->opacity : 1 - d->clearness",
  "d->clearness > 0 ? 1 - d->clearness : d->opacity")
m("map-not-clamped", "condition", "materials", '*is_clamped = ffd_text_is_any_case(*word, "on");',
  '*is_clamped = ffd_text_is_any_case(*word, "off");')

m("digits-of-plain-words", "off by one", "mixed_faces", "digits > 0 && digits <= 8 ? (size_t)bytes_number(values << (64 - 8 * digits)) : 0;",
  "digits > 0 && digits <= 8 ? (size_t)bytes_number(values << (64 - 8 * digits)) + 1 : 0;")
m("vertices-that-were-not-there", "bound", "mixed_faces", "while (vertex < end && ffd_obj_walk_next(&walk)) {", "while (ffd_obj_walk_next(&walk)) {")
m("wanted-after-the-first", "limit", "mixed_faces, cli_tears", "return *(const uint32_t *)wanted < *(const size_t *)vertex;",
  "return *(const uint32_t *)wanted <= *(const size_t *)vertex;")
# io/gltf

m("data-uri-is-a-file", "condition", "buffer_count", "count += is_uri && !is_data(&string);", "count += is_uri;")
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
m("texture-turned", "sign", "cli_convert_texcoords", ".to_v = {-sine * scale[0], cosine",
  ".to_v = {sine * scale[0], cosine")
m("set-of-a-texture", "operation", "cli_convert_texcoords", "a != texcoords->accessor))", "a > texcoords->accessor))")
m("last-row", "tolerance", "gltf, cli_gltf_scene, cli_broken_gltf, broken_gltf", "#define LAST_ROW_TOLERANCE 1e-5",
  "#define LAST_ROW_TOLERANCE 1e5")
m("first-joint", "order", "cli_skin_weights", "const size_t first_joint = terms[0].joint;",
  "const size_t first_joint = terms[count - 1].joint;")
m("half-an-ulp", "tolerance", "cli_gltf_scene", "if (!(fabs((double)x[c] - (double)y[c]) <= most))",
  "if (!(fabs((double)x[c] - (double)y[c]) < most / 2))")
m("what-stays-shares-an-ulp", "condition left out", "cli_gltf_scene",
  "rounding[c] + (stays ? 0 : file_rounding(allowed, x, y, c));", "rounding[c] + (stays ? 1 : 1) * file_rounding(allowed, x, y, c);")
m("ulp-of-the-largest", "wrong coordinate", "cli_gltf_scene", "ulp_of(allowed->along ?", "ulp_of(true || allowed->along ?")
m("double-rounding-left-out", "tolerance", "cli_gltf_scene", "rounding[c] *= ROUNDINGS * DBL_EPSILON;",
  "rounding[c] *= 0 * ROUNDINGS * DBL_EPSILON;")
m("first-of-the-scene", "order", "cli_gltf_scene", "for (size_t i = node->child_count; i-- > 0;)",
  "for (size_t i = 0; i < node->child_count; i++)")
m("buffer-too-short", "bound", "gltf, cli_broken_gltf, cli_broken_files",
  "buffer->kind != BUFFER_EMPTY && buffer->size < buffer->length",
  "buffer->kind != BUFFER_EMPTY && buffer->size + 4 < buffer->length")
m("absolute-uri", "check left out", "gltf, cli_broken_gltf", "if (uri[0] == '/' || uri[0] == '\\\\')",
  "if (uri[0] == '\\\\')")
m("detail-below-its-node", "parent", "cli_stays_behind", "parents[detail] = parents[n];", "parents[detail] = n;")
m("detail-already-shown", "check left out", "cli_stays_behind",
  "if (!d->in_scene[detail])", "if (!d->in_scene[detail] || parents[detail] == GLTF_NONE)")
m("detail-below-a-detail", "check left out", "cli_stays_behind", "c < node->child_count && d->stands_in[n]",
  "c < node->child_count && d->stands_in[n] && n == 0")
m("details-without-scenes", "check left out", "cli_stays_behind", "if (parents[n] == GLTF_NONE && !d->stands_in[n])",
  "if (parents[n] == GLTF_NONE)")
m("details-of-a-selection", "call left out", "cli_stays_behind", "mark_stand_ins(s, n, &waiting);", "")
m("shape-by-its-own-transform", "place", "cli_colliders", "if (d->collides[n]) memcpy(d->world + 12 * n, d->world + 12 * parents[n], 12 * sizeof *d->world);",
  "if (parents[n] != GLTF_NONE && d->collides[parents[n]])\n        memcpy(d->world + 12 * n, d->world + 12 * parents[n], 12 * sizeof *d->world);")
m("shape-that-is-seen", "left out", "cli_colliders", "d->hidden[shape] = d->collides[shape] = true;", "d->collides[shape] = true;")
m("shapes-of-shapes", "check left out", "cli_colliders", "if (!d->collides[queue[i]]) status = add_below(", "status = add_below(")
m("shapes-elsewhere", "left out", "cli_colliders", "d->shapes_shared += !stand_alike(d, shape, n);", "d->shapes_shared += 0;")
m("shape-without-scenes", "condition", "cli_colliders", "d->stands_in[found] = d->stands_in[found] || !walk.collides;", "d->stands_in[found] = true;")
m("shape-that-stays", "left out", "cli_colliders", "if (w->document->collides[n]) memcpy(w->rig->world + 12 * n, made_of(w, p), sizeof identity);",
  "if (w->document->collides[n])\n        memcpy(w->rig->world + 12 * n, w->document->world + 12 * n, sizeof identity);")
m("shape-with-a-place", "check left out", "cli_colliders", "if (!(s->nodes[n] & IS_SHOWN) || d->collides[n])", "if (!(s->nodes[n] & IS_SHOWN))")
m("triggers-left", "bound", "cli_colliders", "while (walk->shapes < 2)", "while (walk->shapes < 1)")
m("joints-of-a-selection", "operation", "cli_stays_behind", "skin >= 0 && j < d->skins[skin].joint_count",
  "skin > 0 && j < d->skins[skin].joint_count")
m("joints-that-are-animated", "check left out", "cli_stays_behind", "if (kinds == 0 && s->nodes[n] & IS_ANIMATED)",
  "if (s->nodes[n] & IS_ANIMATED)")
m("instances-out-of-reach", "bound", "cli_gltf_scene, gltf, scene",
  "if (least > reach->max[r] || largest < reach->min[r])",
  "if (least > reach->max[r] && largest < reach->min[r])")
m("normalized-least", "bound", "gltf_storage", "return value / scale < -1 ? -1 : value / scale;",
  "return value / scale;")
m("sparse-index", "endian", "gltf, gltf_models, cli_gltf_storage", "return at[0] | (uint32_t)at[1] << 8;",
  "return at[1] | (uint32_t)at[0] << 8;")
m("sparse-behind-the-tile", "bound", "gltf_storage, gltf, gltf_models", "if (index - first >= count) return;",
  "if (index - first > count)\n            return;")
m("quote-in-a-plain-string", "check left out", "base", "*c < 0x7f && *c != '\"' && *c != '\\\\')", "*c < 0x7f && *c != '\\\\')")
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
m("directions-of-draco", "left out", "gltf_mended", "if (step > 0 && has_directions(d, value, accessor))", "if (step < 0 && has_directions(d, value, accessor))")
m("directions-not-quantized", "condition", "gltf_packed", "if (step > 0 && has_directions(d, value, accessor))", "if (has_directions(d, value, accessor))")
m("handedness-of-draco", "left out", "gltf_mended", "v[3] = v[3] < 0 ? -1.0f : 1.0f;", "v[3] += 0;")
m("weights-of-one-set", "bound", "gltf_mended", "for (size_t i = 0; i < 4 * of->set_count; i++) sum += of->weight[i];", "for (size_t i = 0; i < 4; i++)\n        sum += of->weight[i];")
m("weights-about-one", "tolerance", "gltf_mended", "? fabs(sum - 1) <= SUM_ROUNDING", "? fabs(sum - 1) <= 0 * SUM_ROUNDING")
m("weights-of-steps", "left out", "gltf_mended", "of->weight[largest] = (double)ffd_gltf_round(of->weights[largest / 4].accessor, rest);", "(void)rest;")
m("joints-of-two-weights", "check left out", "gltf_mended", "m->partner[set->joints] == (size_t)set->weights &&", "")
m("weights-mended-again", "check left out", "gltf_mended", "!m->done[set->weights] &&", "")
m("bounds-before-mending", "operand", "gltf_mended", "edit_bounds(saver, unpacking->accessor, NULL, unpacking->bytes, edits);",
  "edit_bounds(saver, unpacking->accessor, NULL, saver->document->layouts[unpacking->accessor].data, edits);")
m("meshopt-triangles", "check left out", "meshopt, gltf_packed", "view->mode == MESHOPT_TRIANGLES && view->count % 3)",
  "view->mode == MESHOPT_TRIANGLES && view->count % 3 > 2)")
m("meshopt-wide-deltas", "table", "meshopt_streams", "widths[2][4] = {{0, 1, 2, 4}, {1, 2, 4, 8}}", "widths[2][4] = {{0, 1, 2, 4}, {0, 2, 4, 8}}")
m("meshopt-turned-deltas", "direction", "meshopt_streams", "(delta >> turn | delta << (32 - turn) % 32)",
  "(delta << turn | delta >> (32 - turn) % 32)")
m("meshopt-bytes-too-many", "check left out", "meshopt_streams", "if (status == FFD_OK && from.at < from.end)",
  "if (status == FFD_OK && from.at > from.end)")
m("meshopt-edge-not-remembered", "check left out", "cli_files", "t->is_broken = age >= t->edge_count || t->is_broken;", "")
m("meshopt-scale-of-a-colour", "bound", "meshopt, meshopt_streams", "const int alpha = from[3] & scale >> 1,", "const int alpha = from[3] & scale,")
m("glb-newer-version", "error code", "gltf, cli_broken_gltf",
  "if (version != GLB_VERSION) return ffd_fail_file(error, FFD_E_UNSUPPORTED,",
  "if (version != GLB_VERSION)\n        return ffd_fail_file(error, FFD_E_INVALID,")
m("primitive-mode", "limit", "gltf, cli_broken_gltf", "number <= MODE_FAN && floor(number) == number",
  "number <= MODE_UNKNOWN && floor(number) == number")
m("base64-in-capitals", "check left out", "gltf, cli_liberal", "exact ? DATA_BASE64 : DATA_BASE64_ODD",
  "exact ? DATA_BASE64 : DATA_PLAIN")
m("base64-not-marked", "check left out", "gltf, cli_liberal", "if (coding == DATA_PLAIN)", "if (!coding && !size)")
m("allowed-by-another-job", "left out", "cli_liberal", "rules = ffd_hash_blocks(blocks, 2);",
  "rules = ffd_hash_blocks(blocks, 1);")
m("files-of-buffers", "operation", "hash_cache, cli_batch_resume, cli_pipeline",
  "if (d->buffers[i].kind != BUFFER_FILE) continue; char *path = ffd_path_beside(d->path, d->buffers[i].path);",
  "if (d->buffers[i].kind != BUFFER_FILE || i == 0)\n            continue;\n"
  "        char *path = ffd_path_beside(d->path, d->buffers[i].path);")
m("extension-is-there", "operation", "gltf, gltf_packed, cli_gltf_scene",
  "return ffd_gltf_extension(d, value, extension) != JSON_NONE;",
  "return ffd_gltf_extension(d, value, extension) == JSON_NONE;")
m("texcoords-go-down", "sign", "cli_convert, cli_convert_texcoords",
  "values[2 * i + 1] = 1 - (to_v[0] * u + to_v[1] * v + to_v[2]);",
  "values[2 * i + 1] = to_v[0] * u + to_v[1] * v + to_v[2];")
m("interleaved-bytes", "bound", "gltf_save, overlap", "distance < x->size || distance + y->size > x->stride;",
  "distance < x->size || distance + y->size >= x->stride;")
m("skins-use-accessors", "member name", "gltf_save, cli_gltf_scene",
  'mark_number(d, ffd_json_span_member(&d->tree, s, "inverseBindMatrices"), used);',
  'mark_number(d, ffd_json_span_member(&d->tree, s, "inverseBindMatrix"), used);')
m("stretch-beyond-its-piece", "bound", "cli_gltf_storage, gltf_models",
  "const size_t length = there < size - done ? there : size - done;", "const size_t length = there;")
m("stretch-of-another-place", "off by one", "cli_gltf_storage, gltf_models",
  "ffd_gltf_content_at(w->saver, w->buffer, offset + done, &bytes);", "ffd_gltf_content_at(w->saver, w->buffer, offset, &bytes);")

m("channel-not-repeated", "table", "cli_gltf_follow, cli_faults", '"/animations/*/channels/+/target/', '"/animations/*/channels/*/target/')
m("shape-of-a-manifold", "table", "cli_gltf_follow, cli_faults", "{GLTF_INDEX_SHAPE, MANIFOLD", "{GLTF_INDEX_ACCESSOR, MANIFOLD")
m("trigger-of-a-body", "table", "cli_gltf_follow", 'BODIES "trigger/geometry/mesh"', 'BODIES "trigger/mesh"')
m("normals-of-silhouettes", "table", "cli_gltf_follow", 'EDGES "silhouetteNormals"', 'EDGES "normals"')
m("indices-left-twice", "figure", "cli_gltf_follow", "if (value == last) continue;", "if (value == last + 1)\n            continue;")
m("bounds-of-weight-0", "condition", "cli_stale_bounds", "d->shapes[shape - d->base.part_count].weight != 0 &&",
  "d->shapes[shape - d->base.part_count].weight != 1 &&")
m("bounds-above-a-node", "limit", "cli_stale_bounds", "for (; n != GLTF_NONE && !s->nodes[n]; n = s->document->parents[n])",
  "for (; n != GLTF_NONE && !s->nodes[n]; n = GLTF_NONE)")
m("lower-half-of-an-octahedron", "term left out", "meshopt", "const double outside = z < 0 ? -z : 0;",
  "const double outside = z < 0 ? 0 : 0;")
m("largest-of-a-quaternion", "index", "meshopt", "to[(largest + 1 + a) % 4] = to_integer(", "to[(largest + 3 - a) % 4] = to_integer(")
m("double-precision", "error code", "gltf", '!is_used(c->tree, "KHR_accessor_float64")', '!is_used(c->tree, "KHR_accessor_float32")')
m("older-texture-first", "order", "materials", "if (first.texture != JSON_NONE) return first;",
  "if (first.texture != JSON_NONE && second.texture == JSON_NONE)\n        return first;")
m("older-texture-left-out", "condition", "materials", "second.texture != JSON_NONE || first.factor == JSON_NONE ? second : first",
  "first.factor == JSON_NONE ? second : first")
m("mask-without-cutoff", "default", "materials", "return is_valid ? number : HALF;", "return is_valid ? number : 0;")
m("wraps-exchanged", "index", "materials", 'material->wrap[1] = read_wrap(d, d->sampler_values.values[sampler], "wrapT");',
  'material->wrap[1] = read_wrap(d, d->sampler_values.values[sampler], "wrapS");')
m("mirror-is-clamp", "constant", "materials", "mode == MIRRORED_REPEAT ? TEXTURE_MIRROR", "mode == MIRRORED_REPEAT ? TEXTURE_CLAMP")
m("compressed-image-as-it-is", "wrong source", "materials", "view == GLTF_NONE ? NULL : ffd_gltf_view_bytes(d, view);",
  "view == GLTF_NONE\n                                           ? NULL\n                                           : d->buffers[0].data + d->model.views[view].offset;")
m("image-of-a-view-twice", "cache left out", "materials", 'v == GLTF_NONE ? image : v);', 'image);')

m("run-of-results-shifted", "stride", "gltf, cli_gltf_scene, cli_outside", "arrays->round(xyz + 3 * i, 3 * (end - i), stream->result + 3 * (first + i));",
  "arrays->round(xyz + 3 * i, 3 * (end - i), stream->result + 3 * first);")
m("short-indices-by-their-low-byte", "endian", "cli_tears", "for (size_t i = 0; i < count && size == 2; i++) indices[i] = at[2 * i] | (uint32_t)at[2 * i + 1] << 8;",
  "for (size_t i = 0; i < count && size == 2; i++)\n        indices[i] = at[2 * i];")
# io/gltf/animation

m("key-at-its-time", "bound", "gltf_animation, page_rig", "return *(const double *)key <= *(const double *)time;",
  "return *(const double *)key < *(const double *)time;",
  "if (sampler->times[middle] <= time) low = middle;", "if (sampler->times[middle] < time) low = middle;")
m("slerp-the-long-way", "sign", "gltf_animation, cli_view_animation", "sign = cosine >= 0 ? 1 : -1", "sign = 1")
m("spline-not-normalized", "left out", "gltf_animation", "if (is_rotation) normalize(value);", "if (!is_rotation) normalize(value);")
m("spline-tangents-swapped", "operand", "gltf_animation", "const double *const in = out + width, *const v1 = in + width;",
  "const double *const in = out + width, *const v1 = out + width;")
m("falling-times", "bound", "gltf_animation, cli_view_animation", "if (i > 0 && sampler->times[i] < sampler->times[i - 1])",
  "if (i > 1 && sampler->times[i] < sampler->times[i - 1])")
m("keys-of-nothing-are-checked", "condition", "gltf_animation", "if (ffd_gltf_channel_drives(&animation->channels[c])) status = load_channel(",
  "if (animation->channels[c].sampler != GLTF_NONE) status = load_channel(")
m("weights-of-nodes-only", "condition", "gltf_animation", "mesh < 0 ? JSON_NONE : ffd_gltf_first_weight(",
  "d->node_values.count > 0 ? JSON_NONE : ffd_gltf_first_weight(")
m("matrix-not-taken-apart", "left out", "gltf_animation", "if (channel->path < GLTF_WEIGHTS && node->has_matrix)",
  "if (channel->path > GLTF_WEIGHTS && node->has_matrix)")
m("list-keeps-its-memory", "clean-up", "gltf_animation, view_pose", "ffd_budget_return(&d->base.budget, 1, animations->taken);", ";")
m("weights-not-divided", "left out", "view_pose", "(float)(weights[i] / total)", "(float)(weights[i])")
m("anchors-before-are-after", "condition", "view_pose, page_rig", "if (w->after) put_results(&d->parts[part].streams",
  "if (!w->after) put_results(&d->parts[part].streams")
m("offsets-of-the-first", "index", "view_pose", "mat_apply(rest, to->offsets + 3 * i, to->offsets + 3 * i);",
  "mat_apply(rest, to->offsets, to->offsets);")
m("bones-of-no-bind", "left out", "view_pose, page_rig", "ffd_gltf_join_matrix(binds + 12 * j, back, back + 9, bone->bind);",
  "memcpy(bone->bind, binds + 12 * j, sizeof bone->bind);")
m("gltf-quaternion-order", "order", "cli_splats", ".rotation = {q[3], q[0], q[1], q[2]}", ".rotation = {q[0], q[1], q[2], q[3]}")
m("gltf-splats-not-in-place", "left out", "cli_splats", "primitive->attributes[k].semantic = GLTF_SPLAT;",
  "primitive->attributes[k].semantic = GLTF_OTHER;")
m("gltf-scales-of-drafts", "condition", "cli_splats", "if (scales[i] < 0)", "if (scales[i] < -1e30)")
m("gltf-splats-of-a-copy", "left out", "cli_splats", "edit_splats(saver, mesh, p, attributes, use, edits);", "(void)&edit_splats;")
m("gltf-rotation-of-three", "bound", "cli_splats", "slot == GLTF_SPLAT_ROTATION ? 4 : 3", "slot == GLTF_SPLAT_ROTATION ? 3 : 3")

# io/ply

m("ply-big-endian", "endian", "ply", "(8 * (encoding == PLY_BIG_ENDIAN ? size - 1 - i : i))",
  "(8 * (encoding == PLY_BIG_ENDIAN ? i : size - 1 - i))")
m("ply-plain-corner-of-none", "limit", "cli_ply", "if (*count > 0 && largest >= plain->limit)",
  "if (*count > 0 && largest > plain->limit)")
m("ply-plain-unmarked", "left out", "mixed_faces", "for (size_t i = 0; i < count && r->used; i++)",
  "for (size_t i = 1; i < count && r->used; i++)")
m("ply-sign-of-integers", "bound", "ply, cli_ply", "is_signed && word.first < word.last && bits >> (8 * (word.last - word.first) - 1);",
  "is_signed && word.first < word.last && bits > (uint64_t)1 << (8 * (word.last - word.first) - 1);")
m("ply-rows-do-not-fit", "limit", "ply, cli_ply, replay ply", "e->count > left / e->least",
  "e->count > left / 1")
m("ply-colour-of-shorts", "factor", "ply, model, cli_convert", "type == PLY_USHORT ? 65535 : 1",
  "type == PLY_USHORT ? 65536 : 1")
m("ply-normals-mixed", "stride", "ply, cli_ply",
  "slot < PLY_NORMAL_SLOT ? d->file.positions : d->file.directions",
  "slot <= PLY_NORMAL_SLOT ? d->file.positions : d->file.directions",
  "property->slot < PLY_NORMAL_SLOT ? d->file.positions : d->file.directions",
  "property->slot <= PLY_NORMAL_SLOT ? d->file.positions : d->file.directions",
  "property->slot < PLY_NORMAL_SLOT ? d->positions : d->directions",
  "property->slot <= PLY_NORMAL_SLOT ? d->positions : d->directions")
m("ply-rests-by-coefficient", "stride", "cli_splats", "(size_t)(channel * functions + coefficient)",
  "(size_t)((functions > 0) * coefficient * HARMONICS_CHANNELS + channel)",
  "c[i][m][k] = values[i][k * functions + m];", "c[i][m][k] = values[i][m * HARMONICS_CHANNELS + k];")
m("vrm-humanoid-left", "left out", "cli_rig", 'visit_member(v, b, "node", VRM_BONE);', 'visit_member(v, b, "node", VRM_NAMED);')
m("vrm-old-springs-below", "left out", "cli_rig", "mark_spring(s, child); s->pending[waiting++] = child;", "mark_spring(s, root);")
m("vrm-eyes-of-any-bone", "condition", "cli_rig", 'if (eyes != JSON_NONE && ffd_json_span_key_is(tree, b, "head"))',
  'if (eyes != JSON_NONE && !ffd_json_span_key_is(tree, b, "head"))')
m("vrm-springs-not-counted", "figure", "cli_rig", "groups[0].is_one || groups[1].is_one || groups[2].is_one",
  "groups[0].is_one || groups[2].is_one")
m("vrm-aims-not-said", "condition", "cli_rig", '"aim") != JSON_NONE', '"aim") == JSON_NONE')
m("ply-plain-rests-big-endian", "condition", "cli_splats", "d->has_fixed_rows && d->header.encoding == PLY_LITTLE_ENDIAN;",
  "d->has_fixed_rows && d->header.encoding != PLY_ASCII;")
m("ply-plain-rests-in-order", "check left out", "cli_splats",
  "d->offsets[PLY_REST_SLOT + i] == d->offsets[PLY_REST_SLOT] + i * sizeof(float)", "d->offsets[PLY_REST_SLOT + i] != PLY_NOWHERE")
m("ply-splat-marks-mirrored", "left out", "cli_splats", "(turns[i].is_mirrored ? PLY_SPLAT_MIRRORS : 0)",
  "(turns[i].is_mirrored ? 0 * PLY_SPLAT_MIRRORS : 0)")
m("ply-normals-of-zeros", "condition", "cli_memory", "slot < PLY_NORMAL_SLOT || value != 0 || signbit(value)",
  "slot < PLY_SLOT_COUNT || value != 0 || signbit(value)")
m("results-of-zeros", "condition", "cli_memory", "if (memcmp(vectors + 3 * first, zeros, 3 * some * sizeof *zeros) != 0)",
  "if (memcmp(vectors + 3 * first, zeros, 3 * some * sizeof *zeros) != 0 || first < count)")
m("ply-turns-without-harmonics", "condition", "cli_splats", "const bool is_turn = d->new_turns && turns[i].is_turn;",
  "const bool is_turn = turns[i].is_turn;")
m("ply-splats-of-two-types", "condition", "cli_splats", "all = all && d->types[slot] == PLY_FLOAT; return all; } /* Allocates the results",
  "all = d->types[slot] == PLY_FLOAT;\n    return all;\n}\n\n/* Allocates the results")
m("ply-rests-that-do-not-fit", "bound", "cli_splats", "excess |= limit - (bits & INT64_MAX);", "excess = limit - (bits & INT64_MAX);")
m("ply-splats-without-marks", "condition", "cli_splats", "if (d->splat_marks && d->splat_marks[vertex])", "if (d->splat_marks)")
m("ply-read-in-tiles", "bound", "cli_ply, cli_splats", "for (size_t row = first; row < last; row++) { const char *const at",
  "for (size_t row = first; row + 1 < last; row++) {\n        const char *const at")
m("ply-seven-rests", "condition", "cli_splats", "if (d->rest_count == count && have_fractions(", "if (d->rest_count >= count && have_fractions(")
m("ply-splat-of-a-walk", "left out", "cli_splats", "property->slot == PLY_NO_SLOT || !row.changed[property->slot]",
  "property->slot >= PLY_ROTATION_SLOT || !row.changed[property->slot]")
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

m("stl-corners-meet", "operation", "cli_convert", "ffd_stl_read_positions(&e->document->file.base, 0, 3 * facet, 3, positions);",
  "memcpy(positions, e->document->file.new_positions + 9 * facet, sizeof positions);")

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
m("colours-of-255", "check left out", "cli_convert", "value > 255 || floor(value) < value)", "value > 255)")
m("colours-above-1", "check left out", "cli_convert", "limit_colours(&model, target, log);", "")
m("row-of-a-failed-job-stays", "clean-up left out", "cli_batch_positions",
  "if (task->outcome == OUTCOME_FAILED) clear_row(run, task);", "if (task->outcome == OUTCOME_FAILED && 0) clear_row(run, task);")
m("row-of-another-run-cleared", "condition", "cli_batch_positions",
  "task->took_row = head.took_row;", "task->took_row = true;")
m("array-of-an-interrupt", "check left out", "row_array, cli_batch_positions",
  "if (status || ffd_interrupt_requested()) ffd_output_destroy(made);", "if (status) ffd_output_destroy(made);")
m("zeros-are-blank", "check left out", "cli_batch, cli_batch_table", "line->data[i] == 0 || !strchr(", "!strchr(")
m("lone-returns-not-seen", "check left out", "cli_batch_table", "if (has_lone_return(name))", "if (!name)")
m("glb-stride", "stride", "cli_convert, validator", "{12, 12, 8, glb_colour_size(w), 12, 12, 0, 0, 0}",
  "{12, 12, 12, glb_colour_size(w), 12, 12, 0, 0, 0}", "{12, 12, 8, glb_colour_size(w), 12, 12, 0, 0}",
  "{12, 12, 12, glb_colour_size(w), 12, 12, 0, 0}")
m("alpha-is-linear", "check left out", "cli_convert", "c < 3 ? ffd_srgb_to_linear(colour[c]) : colour[c];",
  "ffd_srgb_to_linear(colour[c]);")
m("unit-of-far-nodes", "off by one", "cli_convert, cli_faults",
  "floor((box->min[a] / 2 + box->max[a] / 2) / unit + 0.5)", "floor((box->min[a] / 2 + box->max[a] / 2) / unit)")
m("glb-mode", "constant", "cli_convert", "modes[MODEL_KINDS] = {4, 1, 0};", "modes[MODEL_KINDS] = {4, 3, 0};")
m("glb-vertices-joined", "operation", "cli_convert",
  "if (x->texcoord != y->texcoord) return x->texcoord < y->texcoord ? -1 : 1;",
  "if (x->texcoord != y->texcoord && x->normal != y->normal)\n        return x->texcoord < y->texcoord ? -1 : 1;")
m("obj-name-joins-lines", "format", "cli_convert", "(*c == '\\\\' && !c[1]);", "(*c == '\\\\' && c[1] == '\\\\');")

# job

m("behind-out-of-reach", "check left out", "cli_stays_behind", "if (move->moves && stays)", "if (stays)")
m("behind-a-name-cut", "operation", "cli_stays_behind", "((unsigned char)name[length] & 0xc0) == 0x80",
  "((unsigned char)name[length] & 0xc0) == 0xc0")
m("behind-a-morph", "selection", "cli_stays_behind", "job->desc->as_morph ? RIG_KINDS_OF_MORPHS : RIG_KINDS,", "RIG_KINDS,")
m("joints-of-a-morph", "text", "cli_stays_behind", "job->desc->as_morph ? RIG_MORPHED", "job->desc->morphs ? RIG_MORPHED")
m("joints-of-no-skin", "figure", "cli_stays_behind", "*loose += marked[n] && !joined[n];", "*loose += marked[n] && joined[n];")
m("left-on-a-joint", "left out", "cli_rig", "if (place && is_left(w, n))", "if (place && place->stays && is_left(w, n))")
m("skin-of-no-joints", "left out", "cli_skin_weights", "places = !ffd_gltf_is_skinned(&mesh->primitives[p]);", "places = false;")
m("half-sets", "check left out", "cli_skin_weights", "if (is_whole(&primitive->influences[i])) return FFD_OK;", "if (!primitive) return FFD_OK;")
m("joints-of-no-file", "condition", "cli_batch_positions", "(job->check || ffd_deform_desc_writes(job->desc)) &&", "(job->check || job->desc) &&")
m("splats-moved", "figure", "cli_stays_behind, job", "totals->splats_moved += moved;", "totals->splats_moved = moved;")
m("splats-in-the-scene", "left out", "cli_splats", "if (!transform.identity && !transform.singular) ffd_splat_turn_to_file",
  "if (transform.singular)\n            ffd_splat_turn_to_file")
m("splats-broken", "figure", "cli_splats", "totals->splats_broken += outcome == SPLAT_BROKEN && scratch->changed[i];",
  "totals->splats_broken += outcome == SPLAT_BROKEN && scratch->changed[i] > 1;")
m("vrm-a-number-of-no-node", "left out", "cli_rig", "else if (number != JSON_NONE && v->fault)", "else if (number == JSON_NONE && v->fault)")
m("vrm-none-is-a-fault", "condition", "cli_rig", "number >= -1 && number <= -1;", "number >= -1 && number < -1;")
m("splats-of-a-turned-node", "left out", "cli_rig", "(!part->skipped || part->carried) && !part->singular", "!part->skipped && !part->singular")
m("splats-turned-and-not-said", "condition", "cli_rig", "is_turned = is_turned || part->carry[k] != 0;",
  "is_turned = is_turned && part->carry[k] != 0;")
m("report-rms", "figure", "cli_deform",
  "FIGURE(residual.rms)", '.name = "residual.rms", .result = RESULT(residual.max)')
m("report-member", "member name", "cli_report_schema", "FIGURE(displacement.max)",
  '.name = "displacement.most", .result = RESULT(displacement.max)')
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
m("box-without-targets", "left out", "cli_morph_weights", ".bounds_shapes = true", ".bounds_shapes = false")
m("shown-of-a-mixture", "condition", "cli_morph_weights", "!(shown == 1 && part->shapes[last].weight == 1)",
  "!(shown == 1)", "return shown > 1 || !whole;", "return shown > 1 && !whole;")
m("figures-of-the-base", "left out", "cli_morph_weights", "return !job->stored && !job->document->keeps_base &&",
  "return job->stored && !job->document->keeps_base &&")
m("written-as-stored", "condition", "cli_morph_weights", "shown.discards = !writes_shown;", "shown.discards = true;")
m("base-outside-of-all", "condition", "cli_morph_weights", "if (other & OTHER_OUTSIDE && part->shows_shapes)",
  "if (other & OTHER_OUTSIDE)")
m("base-outside-left-out", "call left out", "cli_morph_weights", "shown->base_outside = stored->weighted_outside;", "")
m("cell-without-offsets", "term left out", "cli_morph_weights", "all[a] += fabs(shape->weight) * cell[a];", "all[a] += 0 * cell[a];")
m("report-of-targets", "figure", "cli_morph_weights", "FIGURE(morph_targets.shown_outside)",
  '.name = "morph_targets.shown_outside", .result = RESULT(morph_targets.outside)')
m("not-finite-unshown", "left out", "cli_boxes", "(other & OTHER_STATUS) == FFD_POINT_INVALID ||",
  "(other & OTHER_STATUS) == OTHER_STATUS ||")
m("not-finite-in-ply", "left out", "cli_convert", ".takes_not_finite = true,", ".takes_not_finite = false,")
m("not-finite-unused", "condition", "cli_convert", "if (unfit != SIZE_MAX && !(target->holds & MODEL_HAS_LOOSE))",
  "if (unfit != SIZE_MAX && !target->holds)")
m("empty-scene", "condition", "cli_convert", "if (model->position_count == 0 && model->features & MODEL_HAS_HIDDEN)",
  "if (model->position_count == 1 && model->features & MODEL_HAS_HIDDEN)")
m("splats-translated", "condition", "cli_stays_behind", "job->totals.splats_moved > 0 && !only_translates(&job->chain)",
  "job->totals.splats_moved > 0 || !only_translates(&job->chain)")
m("splats-fading", "left out", "cli_stays_behind", "return !(chain->outside.extend && chain->outside.falloff > 0);",
  "return true;")
m("depfile-repeats", "left out", "cli_boxes", "if (status || (once && known.count == before))",
  "if (status || (once && known.count < before))")
m("info-box-without-margin", "operand", "cli_info_parts", "bounds.max, lattice->spec->margin, box->min",
  "bounds.max, lattice->spec->box_min, box->min")
m("info-box-not-fitted", "left out", "cli_info_parts", "return status || !fits ? status : ffd_lattice_fit",
  "return status || fits ? status : ffd_lattice_fit")
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
m("report-out-of-order", "operation", "cli_batch_report, cli_batch",
  "report->is_mixed = report->is_mixed || number < report->place_count;", "report->is_mixed = false;")
m("merged-exit-code", "bound", "cli_report_merge", "code >= 0 && code <= 7", "code >= 0 && code <= 8")
m("gate-exit", "error code", "cli_fail_on", "return line.length ? ffd_fail_file(error, FFD_E_GATE,",
  "return line.length ? ffd_fail_file(error, FFD_E_INVALID,")
m("shapes-outside", "error code", "cli_outside, cli_gltf_scene, cli_errors",
  "if (desc->outside == FFD_OUTSIDE_ERROR && stores_outside(totals)) return ffd_fail_file(error, FFD_E_EMBEDDING,",
  "if (desc->outside == FFD_OUTSIDE_ERROR && stores_outside(totals))\n        return ffd_fail_file(error, FFD_E_INVALID,")
m("range-of-offsets", "sign", "cli_as_morph, cli_convert", "morph ? model->morphs[morph - 1].positions[i] - model->positions[i]",
  "morph ? model->morphs[morph - 1].positions[i] + model->positions[i]", "morph ? model->morph_positions[i] - model->positions[i]",
  "morph ? model->morph_positions[i] + model->positions[i]", "less ? values[i] - less[i] : values[i];",
  "less ? values[i] + less[i] : values[i];")
m("clip-times-ascend", "bound", "morph_clip, cli_morphs, replay clip", "!(rounded > clip->times[clip->key_count - 1])",
  "!(rounded >= clip->times[clip->key_count - 1])")
m("clip-of-doubles", "rounding", "cli_morphs", "const float rounded = (float)time + 0.0f;", "const double rounded = time + 0.0;")
m("clip-two-weights", "check left out", "morph_clip, cli_morphs, replay clip", "if (p->last_key[target] == clip->key_count)",
  "if (p->last_key[target] > clip->key_count)")
m("clip-target-not-known", "check left out", "morph_clip, cli_morphs", "if (!ffd_intern_find(known, name, strlen(name), &number))",
  "if (!ffd_intern_find(known, name, strlen(name), &number) && !name)")
m("clip-weight-stays", "state", "cli_morphs", "weights[clip->weights[i].target] = 0;", "weights[clip->weights[i].target] += 0;")
m("clip-default-weights", "condition", "cli_morphs", "if (names[t] == KEEPS && !ffd_gltf_weight(d, default_value, &row[t]))",
  "if (names[t] == IS_ZERO && !ffd_gltf_weight(d, default_value, &row[t]))")
m("clip-weights-of-a-node", "condition", "cli_morphs", "size_t sampler = own ? GLTF_NONE : w->samplers[mesh];",
  "size_t sampler = w->samplers[mesh];")
m("clip-own-bytes", "condition", "cli_morphs", "w->replaced.values[w->replaced.count++] = old;",
  "w->replaced.values[0] = old;\n    w->replaced.count = 1;")
m("target-of-others-lost", "condition", "cli_as_morph", "(is_own || ffd_gltf_is_partly_selected(", "(is_own && ffd_gltf_is_partly_selected(")
m("target-of-others-lost-unsaid", "condition", "cli_as_morph", "old >= 0 && (size_t)old != accessor &&", "old >= 0 && (size_t)old == accessor &&")
m("target-bytes-in-use", "condition", "cli_morphs", "if (users[a] > 0) ffd_gltf_add_accessor_bytes(", "if (users[a] > 2)\n            ffd_gltf_add_accessor_bytes(")
m("target-bytes-of-others", "condition", "cli_morphs", "count += marks[i] == IS_OURS;", "count += marks[i] != IS_FREE;")
m("target-bytes-of-an-image", "condition", "cli_morphs", "if (views[v]) ffd_gltf_add_view_bytes(d, v, kept);", "if (!views[v])\n            ffd_gltf_add_view_bytes(d, v, kept);")
m("target-bytes-compressed", "condition", "cli_morphs", "if (buffer != GLTF_NONE && size != GLTF_NONE) add_bytes(", "if (buffer == GLTF_NONE && size != GLTF_NONE)\n            add_bytes(")
m("target-bytes-sparse", "left out", "cli_morphs", "add_packed(d, sparse->values_view, sparse->values_offset, sparse->count, layout->element_size, list);", "")
m("clip-replaced", "left out", "cli_morphs", "ffd_json_span_string_is(tree, name, w->clip->name)", "ffd_json_span_string_is(tree, name, \"\")")
m("clip-of-a-conversion", "stride", "cli_morphs", "clip->key_count * target_count(plan, m), NULL", "clip->key_count * 1, NULL")
m("morph-in-its-place", "operand", "cli_morphs, cli_as_morph", ": ffd_gltf_target_count(file, m);",
  ": ffd_gltf_target_count(d, m);")
m("morphs-leave-nothing-behind", "figure", "cli_splats", "if (target->behind[kind].count > all->behind[kind].count)",
  "if (target->behind[kind].count < all->behind[kind].count)")
m("edges-of-no-target", "figure", "cli_morphs", "HELD_BACK(edges.is_known), TARGETS(JOIN_ALL)",
  "HELD_BACK(edges.is_known)")
m("morph-worst-counts", "condition", "cli_morphs", "target->counts[FFD_INSIDE] < before->counts[FFD_INSIDE]",
  "target->counts[FFD_INSIDE] > before->counts[FFD_INSIDE]")
m("morph-file-warned-again", "condition", "cli_morphs", "job->file_log = k == 0 ? *log : (mesh_log){0};", "job->file_log = *log;")
m("morph-failure-unnamed", "left out", "cli_morphs", "if (count < 2 || error->status == FFD_E_MEMORY)", "if (count < 200)")
m("morph-name-in-a-batch", "format", "cli_morphs", "if (*c == '\\'') ffd_buffer_append(text, c, 1);",
  "if (*c == '\"')\n            ffd_buffer_append(text, c, 1);")
m("morph-name-not-resumed", "left out", "cli_morphs", 'ffd_buffer_text(content, "--morph="); quote_name(name, content);',
  'ffd_buffer_text(content, "--morph=");')
m("sparse-too-soon", "bound", "cli_morphs", "if (sparse->count <= count / 3)", "if (sparse->count <= count / 2)")
m("sparse-short-numbers", "bound", "cli_morphs", "sparse->index_size = count <= SHORT_INDICES ? 2 : 4;",
  "sparse->index_size = count <= SHORT_INDICES + 1 ? 2 : 4;")
m("sparse-as-morph", "condition", "cli_morphs", "if (!d->base.sparse_targets || version->accessor == GLTF_NONE)", "if (version->accessor == GLTF_NONE)")
m("sparse-target-of-a-view", "format", "cli_morphs", "if (!append->sparse) write_target(saver, version, text);", "write_target(saver, version, text);")
m("morph-limit-of-viewers", "bound", "cli_morphs", "if (count <= MORPHS_PLAYED || count <= ffd_gltf_target_count(d, m))",
  "if (count < MORPHS_PLAYED || count <= ffd_gltf_target_count(d, m))")
m("changed-corners", "bound", "changed_faces", "if (filler->corner < filler->corners && vertex < filler->faces->vertex_count)",
  "if (filler->corner < filler->corners || vertex < filler->faces->vertex_count)")
m("changed-counts-saved", "check left out", "changed_faces", "if (is_spliced && meets_all(all->document, number, &walk))",
  "if (is_spliced)")
m("changed-words-saved", "check left out", "changed_faces", "if (!is_ahead(splice, word)) {", "if (false) {")
m("list-past-the-file", "bound", "changed_faces", "if (*count <= (size_t)(walk->last - walk->at) / least)", "if (least > 0)")
m("face-past-the-file", "bound", "changed_faces", "if (count > (size_t)(e->walk.scan.last - e->walk.scan.at))", "if (count == SIZE_MAX)")
m("changed-normals", "check left out", "changed_faces", "if (found == count || corner.vertex != faces->corners[found])", "if (found == count)")

m("info-member", "member name", "info, cli_info", '"boundary_edges", topology->boundary_edges',
  '"boundary_edge", topology->boundary_edges')

m("inside-by-an-embedding", "check left out", "cli_hostile_inputs", "(location->status != FFD_INSIDE && location->status != FFD_MULTIPLE) ||",
  "(location->status != FFD_MULTIPLE) ||")
m("multiple-by-an-embedding", "check left out", "cli_hostile_inputs", "(location->status != FFD_INSIDE && location->status != FFD_MULTIPLE) ||",
  "(location->status != FFD_INSIDE) ||")
m("missed-by-a-tile", "operation", "cli_hostile_inputs", "FROM(first_missed, JOIN_LEAST)",
  "FROM(first_missed, JOIN_WITH)")
m("missed-is-no-failure", "check left out", "cli_hostile_inputs", "if (totals->first_missed != UINT64_MAX)",
  "if (totals->first_missed == 0)")
m("embedding-without-rounding", "term left out", "cli_snap, cli_embedding, cli_hostile_inputs",
  "return ffd_locator_accepts(link->locator, x, location, half, link->snap);",
  "return ffd_locator_accepts(link->locator, x, location, half, 0 * link->snap);")
m("lattice-takes-no-memory", "limit", "cli_hostile_inputs", "if (ffd_budget_take(budget, bytes, 1, NULL) == FFD_OK)",
  "if (ffd_budget_take(budget, bytes, 0, NULL) == FFD_OK)")
m("lattices-of-a-job", "limit", "cli_hostile_inputs", "#define MOST_LATTICES 1024", "#define MOST_LATTICES 1025")
m("memory-of-a-new-lattice", "check left out", "cli_hostile_inputs",
  "return ffd_lattice_memory_take(&budget, &spec, 0, error);", "return budget.most ? FFD_OK : ffd_lattice_memory_take(&budget, &spec, 0, error);")
m("beside-a-dry-run", "check left out", "cli_materials", "job->desc->dry_run ? rehearse(job, options, error) : save(",
  "job->desc->dry_run ? (rehearse(job, options, error), FFD_OK) : save(")
m("flaws-of-a-box", "message", "cli_boxes", "ffd_flaws_warn(&document->flaws, ffd_source_name(source), log);", "(void)log;")
m("flaws-of-a-known-box", "message", "cli_boxes", "for (size_t i = 0; i < box->warnings.count; i++) ffd_log_line(",
  "for (size_t i = 1; i < box->warnings.count; i++)\n        ffd_log_line(")
m("figures-of-a-dry-run", "figure", "cli_batch_report", ".planned = task->dry && !answer->rehearsed && !result->status,",
  ".planned = false && answer && task->dry,")
# job: torn edges, lattices side by side

m("cut-beside-the-jump", "condition", "cli_jumps", "const int next = halves[1].defect > halves[0].defect;",
  "const int next = halves[1].defect < halves[0].defect;")
m("other-half-forgotten", "left out", "tears", "if (jumps[1 - next]) let_wait(edge, &halves[1 - next]);",
  "if (jumps[1 - next] && edge->count > PARTS)\n        let_wait(edge, &halves[1 - next]);")
m("edges-cut-without-end", "limit", "cli_jumps", "atomic_fetch_sub(field->left, evaluations) >= evaluations",
  "atomic_fetch_sub(field->left, evaluations) >= evaluations - (1LL << 60)")
m("staying-lost-with-moving", "left out", "cli_jumps", "if (!status || status == FFD_E_LIMIT) fill_result(", "if (!status)\n        fill_result(")
m("blocks-at-two-places", "left out", "cli_blocks", "bool found = distance(at[0], at[1]) <= off;",
  "bool found = distance(at[0], at[1]) >= 0;")
m("slope-of-the-rounding", "left out", "cli_blocks", "limit += change_of(gradient, off);", "limit += change_of(gradient, 0);")
m("place-without-rounding", "term left out", "cli_blocks", "(snap + ffd_link_rounding(link)) * vec_length(row)",
  "snap * vec_length(row)")
m("cells-are-small", "wrong constant", "cli_blocks", "NEAR_CELLS * cell / link->lattice->diagonal",
  "1e-3 * cell / link->lattice->diagonal")
m("neighbour-on-the-same-side", "left out", "cli_blocks", "if (!goes_on(own, next, half, snap))", "if (!goes_on(own, next, half, snap) && half[0] < 0)")
m("snapped-as-held", "left out", "cli_blocks", "return work->snaps ? work->chain->links[block].snap : 0;",
  "return work->chain->links[block].snap;")
m("middle-not-shared", "left out", "cli_blocks", "bool found = holds_one(search, a, middle, 1) && !search->status",
  "bool found = a > b && holds_one(search, a, middle, 1) && !search->status")
m("places-not-looked-for", "left out", "cli_blocks", "found = reaches_into(search, turn ? b : a, turn ? a : b);",
  "found = a > b && reaches_into(search, turn ? b : a, turn ? a : b);")
m("extended-as-moved", "left out", "cli_outside", "totals->extended_moved += (other & OTHER_MOVED) != 0;",
  "totals->extended_moved++;")
m("fading-as-moved", "wrong constant", "cli_blocks", "> MOVED * link->lattice->diagonal;", ">= 0 * link->lattice->diagonal;")
m("unused-as-staying", "left out", "cli_tears", "job->kept[first + v] &= ffd_part_shows(part, v);",
  "job->kept[first + v] &= !part->hidden;")
m("numbers-of-few-as-of-all", "number", "cli_tears", "torn ? ffd_faces_number(faces, count->vertex) : count->vertex;",
  "count->vertex;")
m("marks-of-few-as-of-all", "number", "cli_tears", "job->kept[p * vertices + faces->numbers[v]];",
  "job->kept[p * vertices + v];")
m("hidden-of-few-as-of-all", "number", "cli_tears", "const uint32_t vertex = ffd_faces_number(mesh->faces, of_faces);",
  "const uint32_t vertex = of_faces;")
m("last-of-eight-marks", "limit", "mixed_faces", "while (marks->planes == 1 && marks->vertices - vertex > sizeof eight) {",
  "while (marks->planes >= 1 && marks->vertices - vertex > sizeof eight) {")
m("vertices-before-a-word", "off by one", "mixed_faces", "set->before[w] = (uint32_t)*count;",
  "set->before[w] = (uint32_t)*count + (w > 0);")

# job: areas and volumes

m("volume-sum-not-exact", "rounding", "quality", "return s->sum + s->lost;", "return s->sum;")
m("zeros-of-two-signs-are-two-vertices", "equality", "quality", "number += 0.0;", "number *= 1.0;")
m("edges-of-both-ways-alike", "sign", "quality", "return from < to ? hash : 0 - hash;", "return from < to ? hash : hash;")
m("area-of-what-hides", "condition", "quality", "if (count > 0 && !is_hidden(work, corners[0]))", "if (count > 0 && (count < 3 || !is_hidden(work, corners[0]) || count > 2))")
m("volume-not-known-as-not-closed", "condition", "cli_check", 'if (isnan(area)) return "not known";', "")
m("volume-too-large-as-not-closed", "condition", "quality, cli_check", "return isfinite(value) ? ldexp(value, exponent) : NAN;", "const double large = ldexp(value, exponent);\n    return isfinite(large) ? large : NAN;")
m("volume-of-large-numbers-unscaled", "overflow", "quality", "work->scale = ldexp(1, -exponent);", "work->scale = ldexp(1, 0 * exponent);")
m("volume-of-the-selection", "order", "cli_check", "measure_extent(job, arrays, result);\n    if (!ffd_selection_is_all(job->document))\n        status = ffd_selection_reduce(job->document, &arrays->faces, error);",
  "if (!ffd_selection_is_all(job->document))\n        status = ffd_selection_reduce(job->document, &arrays->faces, error);\n    measure_extent(job, arrays, result);")
m("area-after-of-many-targets", "condition", "cli_morphs", "count == 1 ? *(const double *)from : NAN;", "count >= 1 ? *(const double *)from : NAN;")

# batch

m("journal-full", "limit", "journal",
  "if (journal->used > journal->slots / 2", "if (journal->used > journal->slots * 2")
m("list-of-an-interrupted-run", "check left out", "cli_batch_positions", "if (desc->pool.dry || ffd_interrupt_requested()) return FFD_OK; const ffd_status status = ffd_report_create(rows->list",
  "if (desc->pool.dry)\n        return FFD_OK;\n    const ffd_status status = ffd_report_create(rows->list")
m("array-stays-unsaid", "condition", "cli_batch_positions", "if (!path || run->rows.is_there ||", "if (!path || !run->rows.is_there ||")
m("journal-not-renamed", "rename left out", "update, journal, cli_batch_resume",
  "const bool placed = ffd_place(successor->temporary, successor->target, true) == 0;",
  "const bool placed = ffd_place(successor->temporary, successor->temporary, true) == 0;")
m("journal-figures-not-checked", "check left out", "journal, cli_batch_report",
  "return ffd_hash_equal(&hash, &slot->figures);", "return slot->size > 0 || ffd_hash_equal(&hash, &slot->figures);")
m("recent-files-forgotten", "condition", "file_table, cli_batch_outputs",
  "if (!place && table->slots)", "if (!place && !table->slots && table->used)")
m("decimal-comma-in-any-table", "condition", "cli_batch_table", "(decimal_comma && *point == ',')", "*point == ','")
m("journal-torn-record", "check left out", "journal, cli_batch_resume",
  "(is_whole(slot) && ffd_hash_equal(&slot->target, target))", "ffd_hash_equal(&slot->target, target)")
m("shard", "off by one", "job_source, cli_batch", "source->count++ % source->desc.shards == source->desc.shard",
  "++source->count % source->desc.shards == source->desc.shard")
m("csv-quote", "operation", "cli_batch_table", "text[i] == '\"' && i + 1 < size && text[i + 1] == '\"'",
  "text[i] == '\"' && i + 1 < size && text[i + 1] == ','")
m("changed-mesh-is-known", "check left out", "hash_cache, cli_batch_resume",
  "mesh->path && ffd_stamp_equal(&mesh->stamp, stamp) && mesh->format == format", "mesh->path && mesh->format == format")
m("kept-bytes-of-before", "check left out", "hash_cache",
  "strcmp(kept->path, path) != 0 || !ffd_stamp_equal(&kept->stamp, stamp)", "strcmp(kept->path, path) != 0")
m("kept-bytes-of-another", "check left out", "hash_cache", "|| strcmp(kept->path, path) != 0 ||", "||")
m("end-before-the-message", "condition", "cli_batch, cli_batch_failures",
  "while (size < 0 || (size_t)size == sizeof block);", "while (size < 0);")
m("resume-without-outputs", "check left out", "cli_batch_resume",
  "&& ffd_hash_equal(&answer->record.outputs, &task->record.outputs);", ";")
m("resume-does-not-replace", "operation", "cli_batch_resume", "desc->force = desc->force || task->resume;",
  "desc->force = desc->force || task->dry;")
m("stop-is-no-failure", "exit code", "cli_batch_failures, cli_batch_signals, cli_batch",
  "*failed = run.counts.failed > 0 || run.dropped;", "*failed = run.counts.failed > 0;")
m("one-worker-a-mesh", "policy", "cli_batch_sweep", "if (!first && !tasks[i]->is_large) first = tasks[i];",
  "if (!first && tasks[i]->is_large)\n            first = NULL;")
m("large-mesh-shared", "limit", "cli_batch_sweep", "if (!first && !tasks[i]->is_large)", "if (!first)")
m("meshes-in-turn", "policy", "cli_batch_sweep",
  "if (is_of(worker, tasks[i]) || !is_taken(pool, worker, tasks[i]))", "if (is_of(worker, tasks[i]) || !is_taken(pool, worker, tasks[i]) || count)")
m("looks-in-any-order", "order", "cli_batch_outputs", "settled = settled && ffd_task_is_settled(task);", "")
m("look-not-learned", "operation", "cli_batch_outputs",
  "ffd_status status = ffd_run_learn(run, task, error);", "ffd_status status = FFD_OK;")
m("resources-of-a-look-left-out", "operation", "cli_batch_outputs",
  "return ffd_paths_add(&look->copies, path, error);", "return FFD_OK;")
m("changed-mesh-not-told", "message", "cli_batch_sweep", "if (known & TOLD || known == state)",
  "if ((known | TOLD) & TOLD || known == state)")
m("changed-mesh-told-again", "message", "cli_batch_sweep",
  "ffd_files_put(&states->first, &task->mesh, known | TOLD, error);", "ffd_files_put(&states->first, &task->mesh, known, error);")
m("mesh-that-changes-in-a-job", "check left out", "job_cache",
  "if (!ffd_stamps_hold(share->files.paths, share->stamps, share->files.count)) state->bytes[0]",
  "if (share->files.count > 1000000)\n        state->bytes[0]")
m("locations-looked-for-again", "cache left out", "cli_batch_sweep", "*filled = true;", "*filled = false;")
m("images-not-in-the-record", "check left out", "cli_batch_sweep",
  "!job->document->converted && ffd_source_is_alone(job->document);", "!job->document->converted;")
m("hash-of-one-of-two-files", "condition", "file, cli_batch_resume",
  "output->hash && output->count == 1 && output->files[0].temporary;", "output->hash && output->count >= 1 && output->files[0].temporary;")
m("deadline-of-one-thread", "left out", "cli_timeout", "ffd_deadline_set(self->deadline);", "ffd_deadline_set(NULL);")
m("search-without-deadline", "left out", "cli_timeout", "size = ends ? next_slice(now, seconds) : MOST_POINTS; status = ffd_deadline_check(error);",
  "size = ends ? next_slice(now, seconds) : MOST_POINTS;")
m("slowness-told-again", "left out", "cli_timeout", "pace->is_told = true;", "pace->is_told = false;")
m("stream-waited-for", "left out", "cli_timeout", "while (!status && poll(&ready, 1, ffd_deadline_left()) <= 0)", "while (!status && poll(&ready, 1, -1) <= 0)")
m("timeout-named-stop", "message", "cli_batch_failures, cli_batch", "worker->timed_out = !worker->stopped;",
  "worker->timed_out = worker->stopped;")
m("memory-of-idle-workers", "clean-up left out", "cli_processors", "if (other != worker && !other->task) finish_worker(other, NULL);",
  "if (other != worker && other->is_ending)\n            finish_worker(other, NULL);")
m("threads-of-jobs-without-memory", "count", "cli_processors", "if (!fits(pool, task, left)) break;",
  "if (!fits(pool, task, UINT64_MAX))\n            break;")
m("memory-without-lattices", "case left out", "job_source, cli_processors", "i == 0 ? word : ffd_word_lattice(word);", "i == 0 ? word : NULL;")

# cli

m("most-threads", "limit", "cli_usage, cli_errors", "count < 1 || count > 1024)", "count < 1 || count > 1000)")
m("size-units", "factor", "cli_usage", "unit *= 1000;", "unit *= 1024;")
m("embedding-of-many", "limit", "cli_usage",
  "if (job->embedding && inputs > 1)", "if (job->embedding && inputs > 2)")
m("exit-of-many", "error code", "cli_deform, cli_many", "code = inputs == 1 ? own : EXIT_NO;", "code = own;")
m("report-over-a-lattice", "check left out", "cli_usage, cli_output, cli_aliases",
  "if (ffd_paths_meet(job->report, job->lattices[i]))", "if (strcmp(job->report, job->lattices[i]) == 1000)")
m("named-twice", "off by one", "cli_deform, cli_many",
  "for (size_t i = 1; i < inputs->count && !code; i++)", "for (size_t i = 2; i < inputs->count && !code; i++)")

# cli/pages

m("page-letter", "operation", "install man", "if (option->letter) printf(\"Fl %c , \", option->letter);",
  "if (option->letter == 'q')\n        printf(\"Fl %c , \", option->letter);")
m("completion-of-folders", "operation", "install completion", '"_filedir -d" : ":"', '"_filedir" : ":"')
m("completion-quote", "format", "install completion", "if (*text == '\\'') fputs(\"'\\\\'\", stdout);",
  "if (*text == '\\\"') fputs(\"'\\\\'\", stdout);")

# what a stored number stands for

m("half-of-the-rounding", "wrong constant", "rounding, cli_snap", "half_epsilon = 0x1p-24", "half_epsilon = 0x1p-25")
m("rounding-not-carried", "wrong space", "cli_snap", "ffd_rounding_transform(transform->linear, half);", "(void)transform;")
m("offset-without-rounding", "term left out", "cli_snap",
  "half[a] += weight * of_offset[a];", "half[a] += 0 * weight * of_offset[a];")
m("snap-shared-by-jobs", "cache key", "cli_snap", "ffd_hash_doubles(&link->snap, 1)", "ffd_hash_doubles(&link->snap, 0)")
m("box-not-widened", "rounding", "cli_snap", "AXES_ROUNDING * fmax(fabs(min[c]), fabs(max[c]))",
  "0 * AXES_ROUNDING * fmax(fabs(min[c]), fabs(max[c]))")

# pictures of a batch

m("picture-of-another-folder", "condition", "run_view, cli_batch_view", "|| output[length] != '/')", "|| output[length] == 0)")
m("picture-leads-up", "check left out", "run_view, cli_batch_view", "while (start && (*start == '/' || ffd_path_leads_out(start)))",
  "while (start && *start == '/')")
m("picture-in-its-own-folder-only", "identity", "cli_batch_view", "ffd_path_join(view->resolved, name) : NULL;",
  "ffd_path_join(view->resolved, task->job.output) : NULL;")
m("page-of-all-shards", "name", "run_view, cli_batch_view", "if (shards > 1) ffd_buffer_format(&name, \"index-", "if (shards > 1000)\n        ffd_buffer_format(&name, \"index-")
m("old-picture-is-current", "check left out", "run_view, cli_batch_view", "&& !is_older(&picture, &mesh);", "&& (mesh.size || !is_older(&picture, &mesh));")
m("older-by-seconds", "order", "run_view", "a->written[1] < b->written[1];", "a->written[1] < 0;")
m("row-not-marked-last", "order", "row_array, cli_batch_positions", "if (!status && count > 1) status = write_vertices(array, row, file, positions, 1, count, piece, error);", "if (!status && count > 1)\n        status = write_vertices(array, row, file, positions, 2, count, piece, error);")
m("row-replaced", "check left out", "cli_batch_positions",
  "desc->if_changed || !ffd_row_is_done(&row->array, row->number);", "desc->if_changed || !task->dry || !ffd_row_is_done(&row->array, row->number);")
m("row-too-large", "check left out", "row_array, cli_batch_positions", "if (isinf((float)positions[i]) && isfinite(positions[i]))", "if (isinf((float)positions[i]) && isnan(positions[i]))")
m("row-of-its-shard", "count", "cli_batch_positions", "job->row = source->count - 1;", "job->row = (source->count - 1) / source->desc.shards;")
m("row-hash-left-out", "check left out", "cli_batch_positions", "if (row && ffd_row_hash(&row->array, row->number, &parts[count++], NULL))", "if (row && count > 0 && ffd_row_hash(&row->array, row->number, &parts[count++], NULL))")
m("array-of-a-pipe", "check left out", "cli_batch_positions", "return text && ffd_file_reads_once(text);", "return text && ffd_file_is_stream(text);")
m("size-of-an-array", "overflow", "row_array", "(row_size(array) == 0 || array->rows <= most / row_size(array)))", "(row_size(array) == 0 || array->rows * row_size(array) <= most))")
m("shown-positions", "state", "cli_batch_positions", "pass->deformed = pass->deformed ? pass->deformed : job->positions;", "")
m("picture-not-checked-before", "check left out", "cli_batch_view", "return picture ? ffd_job_picture_check(picture, desc->force || desc->if_changed, error) : FFD_OK;",
  "return picture ? ffd_job_picture_check(picture, true, error) : FFD_OK;")
m("missing-picture-is-skipped", "condition", "cli_batch_view", "if (has_output && (!picture || answer->has_picture))", "if (has_output)")
m("picture-of-an-older-row", "check left out", "cli_batch_positions", "ffd_journal_find(run->journal, &task->picture_target, &drawn, NULL) && ffd_hash_equal(&drawn.inputs, &task->record.inputs);",
  "ffd_journal_find(run->journal, &task->picture_target, &drawn, NULL);")
m("picture-of-a-row-with-other-bytes", "check left out", "cli_batch_positions", "!ffd_cache_hash(NULL, picture, &bytes, NULL) && ffd_hash_equal(&bytes, &task->drawn);",
  "!ffd_cache_hash(NULL, picture, &bytes, NULL);")
m("picture-of-a-row-forgotten", "left out", "cli_batch_positions", "ffd_journal_put(run->journal, &task->picture_target, &drawn, \"\", 0);", "(void)drawn;")
m("output-made-for-its-picture", "condition", "cli_batch_view", "if (!has_output) status = judge_row(", "if (!picture || !has_output || picture)\n        status = judge_row(")
m("no-picture-behind-a-gate", "condition", "cli_batch_view", "if (picture && (status == FFD_OK || status == FFD_E_GATE))", "if (picture && status == FFD_OK)")
m("picture-failure-forgotten", "error left out", "cli_batch_view", "answer->has_picture = status == FFD_OK || status == FFD_E_GATE;", "answer->has_picture = status < FFD_E_GATE || status >= FFD_OK;")
m("figures-of-no-job", "figure", "cli_batch_view", "if (is_all || !answer->has_picture)", "if (!answer->has_picture)")
m("warnings-said-twice", "check left out", "cli_batch_view", "if (has_line(lines->data, before, line, length))", "if (has_line(lines->data, 0, line, length))")
m("no-room-for-a-picture", "limit", "cli_batch_view", "|| stamp.size < LARGE)", "|| stamp.size < 100 * LARGE)")
m("no-mesh-beside-a-picture", "limit", "cli_batch_view", "|| stamp.size < LARGE)", "|| stamp.size == 0)")
m("picture-of-two-jobs", "check left out", "cli_batch_view", "if (is_taken(files, job, file, &line)) ffd_run_refuse(files, job, \"\", path, line);",
  "if (is_taken(files, job, file, &line) && line == 0)\n        ffd_run_refuse(files, job, \"\", path, line);")
m("embedding-of-the-run", "left out", "cli_batch_positions", "if (strncmp(*word, embedding, sizeof embedding - 1) == 0)", "if (strncmp(*word, embedding, sizeof embedding) == 0)")
m("array-in-place-of-an-embedding", "condition", "cli_batch_positions", "(desc->force && desc->positions && ffd_file_exists(desc->positions))", "(desc->force && desc->positions && !ffd_file_exists(desc->positions))")
m("index-as-an-output", "check left out", "cli_batch_view", "run->view ? ffd_run_view_page(run->view) : NULL};", "NULL};")
m("index-out-of-order", "operation", "cli_batch_view", "|| run->depfile || run->view ||", "|| run->depfile ||")
m("index-replaced", "check left out", "cli_batch_view", ".force = desc->force || desc->jobs.resume,", ".force = true,")
m("index-of-a-dry-run", "option left out", "cli_batch_view", ".dry = desc->pool.dry};", ".dry = false};")
m("picture-in-place", "check left out", "cli_batch_view", "if (in_place && maker->frame->pictures)", "if (in_place && maker->frame->pictures && !has_output && output)")
m("figures-of-skipped-jobs", "condition", "cli_batch_view", "run->report || run->view || run->rows.report ? &task->figures : NULL;", "run->report ? &task->figures : NULL;")
m("figures-of-a-failure", "condition", "run_view, cli_batch_view", "entry->figures.vertices > 0 ? &entry->figures : NULL;", "&entry->figures;")
m("address-not-escaped", "escape left out", "view_index, cli_batch_view", 'strchr("-._~/", *c);', 'strchr("-._~/:?#%&\\"", *c);')
m("quotes-in-attributes", "escape left out", "view_index, cli_batch_view", "*c == '\"' && in_quotes", "*c == 1 && in_quotes")
m("unknown-folds-as-none", "class", "view_index, cli_batch_view", "if (!figures || !figures->folds.is_known) {", "if (!figures) {")
m("det-sorted-up", "sign", "view_index, cli_batch_view", "ffd_buffer_number(html, -folds->min_det);", "ffd_buffer_number(html, folds->min_det);")
m("skipped-counted-as-done", "count", "view_index, cli_batch_view", "index->skipped += row->state == INDEX_SKIPPED;", "index->skipped += row->state == INDEX_FAILED;")

# view

m("markup-in-a-script", "escape left out", "view_page", r'ffd_buffer_text(out, "\\u003c");', 'ffd_buffer_text(out, "<");')
m("markup-in-the-title", "escape left out", "view_page", 'ffd_buffer_text(out, "&lt;");', 'ffd_buffer_text(out, "<");')
m("turned-names", "range", "view_page", "{0x2028, 0x202e}", "{0x2028, 0x202d}")
m("names-of-any-length", "limit left out", "view_page", "if (count == LONGEST) {", "if (count == 1000 * LONGEST) {")
m("positions-rounded-down", "rounding", "view_page", "step > 0 ? nearbyint(x / step) : 0", "step > 0 ? floor(x / step) : 0")
m("box-of-the-first-shape", "term left out", "view_page", "fmin(data->low[a], fmin(x, y))", "fmin(data->low[a], x)")
m("move-of-one-axis", "operation", "view_page", "most = fmax(most, fabs(y - x));", "most = fabs(y - x);")
m("infinite-vertices-drawn", "check left out", "view_page", "is_shown(scene->before + 3 * v) && is_shown(after + 3 * v)",
  "is_shown(scene->before + 3 * v) && after")
m("vertex-beyond-the-array", "off by one", "view_page", "if (indices[i] >= vertices)", "if (indices[i] > vertices)")
m("torn-edges-simplified", "mark left out", "view_reduce", "r->torn[scene->tears[i].vertices[end]] = 1;",
  "r->torn[scene->tears[i].vertices[end]] = 0;")
m("flipped-mixed-with-others", "class", "view_reduce", "r->mesh->flipped && r->mesh->flipped[triangle] ? FLIPPED : PLAIN",
  "r->mesh->flipped && r->mesh->flipped[triangle] ? PLAIN : PLAIN")
m("borders-simplified", "option left out", "view_reduce", "FARTHEST, meshopt_SimplifyLockBorder, nullptr)", "FARTHEST, 0, nullptr)")
m("exception-of-the-simplifier", "wrong type", "view_reduce",
  "meshopt_SimplifyLockBorder, nullptr); return FFD_OK; } catch (...) {",
  "meshopt_SimplifyLockBorder, nullptr);\n        return FFD_OK;\n    } catch (const char *) {")
m("base64-gap", "multiple", "view_page", "#define RUN 3072", "#define RUN 3073")
m("points-kept", "thinning left out", "view_reduce",
  "mesh->point_count = thin_out(mesh->points, mesh->point_count, 1, ratio); ffd_free(r->kept);", "ffd_free(r->kept);")
m("step-of-the-first-torn-edge", "order", "view", "return x->step > y->step ? -1 : x->step < y->step;", "return x->step > y->step ? 1 : -(x->step < y->step);")
m("torn-edges-twice", "class", "view", "return a < b ? a << 32 | b : b << 32 | a; } static int compare_ends",
  "return a << 32 | b; } static int compare_ends")
m("smallest-torn-edges", "order", "view", "return x->step > y->step ? -1 : x->step < y->step ? 1 : compare_ends(a, b);",
  "return x->step > y->step ? 1 : x->step < y->step ? -1 : compare_ends(a, b);")
m("report-over-its-picture", "check left out", "cli_view", "if (s->job.report && ffd_paths_meet(s->job.report, s->output))",
  "if (s->job.report && strcmp(s->job.report, s->output) == 1000)")
m("report-over-the-picture-of-check", "check left out", "cli_view", "s->picture && s->job.report && ffd_paths_meet(s->job.report, s->picture)",
  "s->picture && s->job.report && s->job.report == s->picture",
  "s.picture && s.job.report && ffd_paths_meet(s.job.report, s.picture)", "s.picture && s.job.report && s.job.report == s.picture")
m("lost-triangles-of-a-corner", "loop", "cli_view", "for (size_t c = 0; c < 3 && finite; c++)", "for (size_t c = 0; c < 1 && finite; c++)")
m("cage-of-any-size", "limit left out", "cli_view", "ffd_multiply_size(*count, size[2], count) && *count <= left;",
  "ffd_multiply_size(*count, size[2], count) && *count <= 1000 * left;", "ffd_multiply_size(points, size[2], &points) && points <= left;",
  "ffd_multiply_size(points, size[2], &points) && points <= 1000 * left;")
m("color-of-what-is-not-known", "condition", "cli_view", "color == FFD_VIEW_STATUS || color == FFD_VIEW_DET", "color == FFD_VIEW_STATUS")
m("gate-without-a-page", "condition", "cli_view, view", "if (status == FFD_E_GATE) ffd_fail_name_file(&result->error, ffd_source_name(&work->desc->job->input)); else if (status) {",
  "if (status) {")
m("gate-forgotten-by-a-page", "result left out", "cli_view, view", "status = result->status; /* of the gates */", "status = FFD_OK;")
m("weights-of-a-picture", "shape", "cli_view", "document->shown = shows_shapes(work, document); const uint64_t before = document->budget.taken;",
  "document->shown = false; const uint64_t before = document->budget.taken;")
m("weights-of-a-deformed-file", "shape", "cli_view", "document->shown = shows_shapes(work, document); for (size_t i",
  "document->shown = work->desc->full; for (size_t i")
m("numbers-of-what-is-hidden", "offset", "cli_view", "number += part->vertex_count; } return FFD_OK; } static ffd_status extract",
  "number += is_drawn(d, d->parts[i].node) ? part->vertex_count : 0; } return FFD_OK; } static ffd_status extract")
m("last-corner-of-an-stl-vertex", "order", "cli_view", "for (size_t i = faces->corner_count; i-- > 0;) e->model->numbers",
  "for (size_t i = 0; i < faces->corner_count; i++) e->model->numbers")
m("page-over-an-input", "check left out", "cli_view",
  "is_input = is_input || ffd_file_same(job->lattices[i], desc->output);", "is_input = is_input || ffd_file_same(job->lattices[i], job->input.path);")
m("page-of-two-meshes", "check left out", "cli_view", "if (!status && ffd_mesh_vertex_count(work->other) != count)", "if (!status && ffd_mesh_vertex_count(work->other) < count)",
  "if (!status && ffd_mesh_vertex_count(other) != count)", "if (!status && ffd_mesh_vertex_count(other) < count)")
m("det-without-its-diagonal", "term left out", "cli_view", "for (size_t a = 0; a < 3; a++) f[4 * a] += 1;",
  "for (size_t a = 1; a < 3; a++)\n            f[4 * a] += 1;")
m("flipped-by-the-first-face", "index", "cli_view", "const size_t face = faces[t];", "const size_t face = faces[t / 2];")
m("cage-at-rest-twice", "wrong array", "cli_view", "cage->deformed = copy_points(lattice->deformed, lattice->count);",
  "cage->deformed = copy_points(lattice->rest, lattice->count);")
m("unmarked-instances", "message left out", "cli_view", "if (work->model.nodes_left)", "if (work->model.nodes_left > 1)")
m("name-of-the-left", "sign", "cli_view", '{"left", {-1, 0, 0}}', '{"left", {1, 0, 0}}')
m("picture-of-the-wrong-shape", "shape", "cli_view", "return !work->job.stored && ffd_mesh_shows_shapes(document);",
  "return work->job.stored && ffd_mesh_shows_shapes(document);")
m("unused-take-room", "mark left out", "cli_view", "if (found > 0 && found < scene->vertex_count)", "if (found > scene->vertex_count)")
m("flipped-in-the-first-picture", "condition", "cli_view", "const size_t marked = s->share > 0 ? from->flipped_count : 0;", "const size_t marked = from->flipped_count;")
m("flipped-triangles-first", "offset", "cli_view", "size_t plain = 0, flipped = s->plain_count;", "size_t plain = s->flipped_count, flipped = 0;")
m("coloured-before", "condition", "cli_view", "if (s->share > 0) *own = w->palette;", "*own = w->palette;")
m("broken-image-fails", "error kept", "cli_view", "if (status == FFD_E_MEMORY) return ffd_fail_memory(error); if (status && lost++ == 0)",
  "if (status)\n            return ffd_fail_memory(error);\n        if (status && lost++ == 0)")
m("texture-of-a-broken-image", "colour left out", "cli_view", "to->alpha_cutoff = 0; /* it applied to the texture */", "to->color[0] = 1;")
m("frames-of-any-number", "limit left out", "view", "if (frames == 1 || frames > VIEW_FRAMES)", "if (frames == 1)")
m("picture-not-said", "result left out", "cli_view", "result->picture = desc->output;", "result->picture = NULL;")
m("tears-in-the-first-picture", "condition", "cli_view", "if (!status && share > 0) status = add_marks", "if (!status)\n        status = add_marks")

# rigs that follow

m("polar-of-a-mirror", "check left out", "polar", "if (ffd_mat_is_singular(x, &det) || !(det > 0)) return false;",
  "if (ffd_mat_is_singular(x, &det)) return false;")
m("polar-not-scaled", "operation", "polar", "const double scale = sqrt(sqrt(square_sum(inverse) / square_sum(x)));",
  "const double scale = sqrt(sqrt(square_sum(x) / square_sum(inverse)));")
m("polar-noise-kept", "threshold", "polar, cli_rig", "#define ROUNDING 1e-12", "#define ROUNDING 0.0")
m("quaternion-of-half-a-turn", "selection", "polar", "if (squares[i] > squares[most]) most = i;",
  "if (squares[i] < squares[most]) most = i;")
m("rig-offset-noise-written", "threshold", "cli_rig", "if (fabs(offset[a] - old[a]) <= rounding)", "if (fabs(offset[a] - old[a]) < 0 * rounding)")
m("rig-sheared", "check left out", "cli_rig", "const bool shears = would_shear(g);", "const bool shears = would_shear(g) && n == SIZE_MAX;")
m("rig-singular", "check left out", "cli_rig", "w->singular[n] = is_below || !has_inverse(w->document->world + 12 * n);",
  "w->singular[n] = is_below || (!has_inverse(w->document->world + 12 * n) && !place);")
m("rig-below-what-moves", "condition", "cli_rig", "const bool is_below_changed = p != GLTF_NONE && w->changed[p];",
  "const bool is_below_changed = p != GLTF_NONE && w->changed[p] && place->kinds;")
m("rig-uneven-groups-stay", "left out", "cli_rig", "place->kinds || has_own(d, n) || is_uneven(d, n)",
  "place->kinds || has_own(d, n) || (chosen && n > 99 && is_uneven(d, n))")
m("rig-part-of-a-mesh", "check left out", "cli_rig", "place->stays = !chosen || instanced || place->partial;",
  "place->stays = !chosen || instanced;")
m("rig-not-selected", "check left out", "cli_rig", "place->stays = !chosen || instanced || place->partial;",
  "place->stays = instanced || place->partial;")
m("rig-similarity-without-scale", "operation", "cli_rig",
  "ffd_mat_rotation(f, rotation) ? ffd_cube_root(mat_determinant(f)) : 1", "ffd_mat_rotation(f, rotation) ? 1 : 1")
m("rig-similarity-left-out", "call left out", "cli_rig", "if (shown[s] && !staying[s] && first != SIZE_MAX)",
  "if (shown[s] && staying[s] && first != SIZE_MAX)")
m("rig-binds-of-all-skins-in-place", "share", "cli_rig", "if (known && number < rig->content_count)", "if (known && rig->content_count)")
m("rig-normals-not-carried", "left out", "cli_rig", "if (gradients) ffd_part_carry_gradient(work->part, scratch->gradient + 9 * i);", "(void)gradients;")
m("rig-targets-not-carried", "left out", "cli_rig", "if (work->part->part->carried) carry(work, k, gradients);",
  "if (work->part->part->carried && k > 99) carry(work, k, gradients);")
m("rig-recomputed-normals-not-carried", "left out", "cli_rig", "if (part->carried) carry_direction(part, n);",
  "if (part->carried && n[0] > 2) carry_direction(part, n);")
m("rig-translation-not-of-the-rest", "operation", "cli_rig", "from[a] = value[a] - (is_tangent ? 0 : key->rest[a]);", "from[a] = value[a];")
m("rig-tangents-as-values", "operation", "cli_rig", "const bool is_tangent = key->cubic && i % 3 != 1;", "const bool is_tangent = key->cubic && i % 3 == 5;")
m("rig-sampler-of-several-channels", "share", "cli_rig", "if (change->contents[own] == content) return true;", "if (taken[own]) return true;")
m("rig-outputs-overwritten", "left out", "cli_rig", "if (!change->contents || change->contents[s] == GLTF_NONE) mark(animation->samplers[s].output, used);",
  "(void)change;")
m("rig-values-not-counted", "limit left out", "cli_rig", "ffd_budget_take(rig->budget, content->count, size, error)",
  "ffd_budget_take(rig->budget, 0, size, error)")
m("rig-left-for-the-next-job", "clean-up left out", "rig", "ffd_gltf_free_rig((gltf_document *)document); const ffd_status status = ffd_gltf_begin_results(",
  "const ffd_status status = ffd_gltf_begin_results(")
m("rig-lag-of-cameras", "selection", "cli_stays_behind, cli_rig", "const double lag = kinds ? ffd_rig_lag(&rig->moves[i], diagonal) : 0;",
  "const double lag = ffd_rig_lag(&rig->moves[i], diagonal);")
m("rig-small-lags-said", "threshold", "cli_rig", "#define LAG_SAID 1e-3", "#define LAG_SAID 1e-6")
m("rig-by-a-morph", "check left out", "rig", "desc->rig == FFD_RIG_FOLLOW && (desc->as_morph || desc->morphs || desc->input.space == FFD_SPACE_MESH)",
  "desc->rig == FFD_RIG_FOLLOW && desc->input.space == FFD_SPACE_MESH",
  "desc->rig == FFD_RIG_FOLLOW && (desc->as_morph || desc->input.space == FFD_SPACE_MESH)",
  "desc->rig == FFD_RIG_FOLLOW && desc->input.space == FFD_SPACE_MESH")

# jobs in memory

m("mesh-without-its-buffer", "order", "in_memory", "const output_file *const file = &output->files[i]; if (file->is_memory) status = ffd_memory_give(",
  "const output_file *const file = &output->files[output->count - 1 - i]; if (file->is_memory) status = ffd_memory_give(")
m("failed-resolver-is-missing", "check left out", "in_memory", "status = ffd_memory_judge_path(job->desc->input.path, status, error);",
  "status = FFD_OK;")
m("view-of-a-failed-resolver", "check left out", "in_memory", "status = ffd_memory_judge_path(desc->job->input.path, status, error);",
  "status = FFD_OK;")
m("name-of-a-folder", "check left out", "in_memory", 'if (!*last || strcmp(last, ".") == 0 || strcmp(last, "..") == 0)', "if (!*last)")
m("text-round-meshes", "condition", "in_memory", "(ffd_file_is_stream(path) || ffd_memory_has(path))", "ffd_file_is_stream(path)")
m("lattice-without-a-name", "number", "in_memory", 'snprintf(number, sizeof number, "lattice %zu", k + 1);', 'snprintf(number, sizeof number, "lattice %zu", k);')
m("parent-folder-asked", "check left out", "in_memory", 'else if (relative[0] == \'/\' || !is_inside(root, path)) status = ffd_fail_file(error, FFD_E_IO, named_by, "the file \\"%s\\" is outside the model\'s folder", relative); else status = ffd_memory_find',
  "else if (!path[0]) status = FFD_E_IO; else status = ffd_memory_find")
m("sink-status-lost", "status", "in_memory", 'return status ? ffd_fail_file(error, status, name, "was not taken by the caller") : FFD_OK;',
  '(void)(status ? ffd_fail_file(error, status, name, "was not taken by the caller") : FFD_OK); return FFD_OK;')
m("output-by-short-name", "name", "in_memory", "ffd_path_join(folder->shown, path + folder->head)", "ffd_text_copy(path + folder->head)")
m("unknown-status-passed-on", "check left out", "in_memory", "return status; } return FFD_E_IO;", "return status; } return status;")
m("asked-twice", "cache", "in_memory", "if (!status) return note(files, path, *bytes, error);", "if (!status) return FFD_OK;")
m("factors-exchanged", "name", "in_memory", 'ffd_in_memory_bytes(memory, desc->times_bytes, "times", &desc->times, error)',
  'ffd_in_memory_bytes(memory, desc->times_bytes, "times", &desc->transposed, error)')

# animations of views

m("row-of-the-first", "index", "cli_view_animation", ".top = ffd_layout_row(by, number / by->columns),", ".top = ffd_layout_row(by, 0),")
m("poses-of-one-side", "condition", "cli_view_animation", "const int side = number < w->options->frames ? 0 : 1;", "const int side = 0 * (int)number;")
m("last-pose-too-early", "off by one", "cli_view_animation", "(of->end - of->begin) * (double)i / (double)(count - 1);",
  "(of->end - of->begin) * (double)i / (double)count;")
m("still-by-the-first-numbers", "bound", "page_rig, cli_view_animation", "i < channel->key_count * channel->width; i++)", "i < channel->key_count; i++)")
m("joints-are-nodes", "flag", "cli_view_animation, page_rig", "(node->is_joint ? 1u : 0)", "(node->is_joint ? 0u : 0)")
m("times-of-each-channel", "condition", "cli_view_animation", "if (*place == SIZE_MAX) { *place = to->size / 4;",
  "if (*place == SIZE_MAX || *place == 0) { *place = to->size / 4;")
m("broken-animation-stops-all", "condition", "cli_view_animation", "if (is_broken && animation != scene->animation)", "if (!is_broken && animation != scene->animation)")
m("first-of-two-names", "condition", "cli_view_animation", "scene->animation = alike ? scene->animation : a;", "scene->animation = a;")
m("smallest-of-many-bones", "condition", "view_page", "chosen[at - 1].weight < s->influences[i].weight", "chosen[at - 1].weight > s->influences[i].weight")
m("follows-of-other-vertices", "index", "view_page", "if (follows) put_follow(rig, side, number_of(mesh, side, v));", "if (follows) put_follow(rig, side, v);")

# python

m("interrupt-not-noticed", "check left out", "python_package", "PyErr_CheckSignals() == 0 ? ask(PyList_GetItem(list, 0), done) : -1",
  "ask(PyList_GetItem(list, 0), done)")
m("control-points-in-c-order", "order", "python_package", "return np.ascontiguousarray(array.transpose(2, 1, 0, *range(3, array.ndim)))",
  "return np.ascontiguousarray(array)")
m("columns-in-c-order", "order", "python_package", "self._columns()[indices]", "indices")
m("read-only-written", "check left out", "python_package", "if not array.flags.writeable:", "if not array.flags.writeable and len(array) == 0:")
m("mapped-file-is-read", "condition", "python_package", "memoryview(data).release() except TypeError:", "if hasattr(data, \"read\"):\n            raise TypeError\n        memoryview(data).release()\n    except TypeError:")
m("picture-of-a-gate-lost", "member left out", "python_package", "raised.data = taken[-1][1]", "pass")
m("figures-of-a-gate-lost", "member left out", "python_package",
  "refused.result = _figures(result, check)", "pass")
m("files-of-the-other-mesh", "name", "python_package", "files if other_files is None else other_files", "files")
m("relative-tolerance-not-of-normals", "branch", "python_package",
  "elif desc.relative: desc.direction_tolerance = desc.tolerance", "elif desc.relative: pass")
m("embedded-points-written", "check left out", "python_package", "if arrays.overlap(out, embedding.points):",
  "if out is None:")
m("handle-not-freed", "freed resource", "python_package", "if self.pointer: self._destroy(byref(self.pointer))", "self.freed = True")
m("other-threads-wait", "lock", "python_package", "ctypes.CDLL(_native.__file__)", "ctypes.PyDLL(_native.__file__)")
m("repeated-rows-as-packed", "check left out", "python_package", "return array.copy() if _repeats(array) else array", "return array")
m("fit-lost-in-pickle", "member left out", "python_package", "return _again, (self.text, self._bounds,", "return _again, (self.text, None,")
