// Lit stretches behind coloured glass. A second tree holds the least S of the glass that tints: before it the light is
// as the picture has it; past it the ray is walked through the glass's texels, each with its own tint.

// The light of a lit stretch, but for the common factor.
fn glass_stretch(view: TraverseRay, a: f32, b: f32) -> vec3f {
    let e = epipolar;
    let leaves = traverse_leaves(view.place, view.has_leaves, vec2f(a, b));
    let end_leaf = leaves.y;
    // There is no glass beside the map.
    let covered = glass_covered(view, vec2f(a, b));
    var beside = a < covered.x;
    var level = 0u;
    var index = leaves.x;
    // What no leaf holds whole may be behind glass.
    var tinted = !beside;
    var start = a;
    var sum = vec3f(0.0);
    loop {
        // On while it is as before; both states are told by the least S alone.
        loop {
            if beside || (index << level) >= end_leaf {
                break;
            }
            let clear = view.place.b < tree_minimum(glass_nodes[tree_node(e.samples, view.slice, level, index)]);
            if clear != tinted && (clear || level == 0u) {
                let next = tree_next(level, index);
                level = next.x;
                index = next.y;
            } else if !clear && level > 0u {
                level -= 1u;
                index *= 2u;
            } else {
                break;
            }
        }
        let leaf = min(index << level, end_leaf);
        let is_last = tinted && leaf >= end_leaf;
        var stop = select(traverse_leaf(view, leaf), covered.y, is_last);
        if beside {
            stop = select(covered.x, b, start >= covered.y);
        }
        stop = clamp(stop, start, b);
        sum += glass_walk(view, start, select(start, stop, tinted));
        sum += traverse_clear(view, start, select(stop, start, tinted));
        start = stop;
        if start >= b {
            break;
        }
        beside = is_last;
        tinted = !tinted;
    }
    return sum;
}

// The part of a stretch that the map covers; none of it begins and ends at its end.
fn glass_covered(view: TraverseRay, stretch: vec2f) -> vec2f {
    if SHADOW_KIND != SHADOW_SINGLE {
        return stretch;
    }
    let covered = shadow_covered(view.map_ray, stretch);
    return select(stretch.yy, covered, covered.x < covered.y);
}

// Texel by texel, and before and behind each layer of a texel's glass.
fn glass_walk(view: TraverseRay, a: f32, b: f32) -> vec3f {
    let size = textureDimensions(shadow_glass);
    var walk = shadow_walk_from(view.map_ray, vec2f(size), a);
    var s = a;
    var sum = vec3f(0.0);
    loop {
        if s >= b {
            break;
        }
        // By rounding alone outside the map, where it covers the ray.
        let texel = vec2u(clamp(walk.texel, vec2i(0), vec2i(size) - 1));
        let passed = shadow_glass_next(texel, walk.face, walk.c0.zw, walk.c1.zw, s);
        let leaves = shadow_walk_end(walk);
        let end = clamp(min(leaves, passed), s, b);
        let middle = 0.5 * (s + end);
        let zw = walk.c0.zw + middle * walk.c1.zw;
        let tint = shadow_glass_texel_tint(texel, walk.face, zw.x / zw.y);
        sum += tint * light_ray_tint(view.ray.origin + middle * view.ray.direction) * tint_even(view.ray, s, end);
        if end >= leaves {
            walk = shadow_walk_on(view.map_ray, walk, end);
        }
        s = end;
    }
    return sum;
}
