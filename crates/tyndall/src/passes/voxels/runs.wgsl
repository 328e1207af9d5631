// Runs of a row of voxels. The shader that uses it declares `voxels`, an array of words.

// The first column from `first` on that is dark (flip 0) or lit (flip 0xffffffff); `side` where there is none.
fn voxel_next(side: u32, row: u32, first: u32, flip: u32) -> u32 {
    if first >= side {
        return side;
    }
    var word = first / 32u;
    var bits = (voxels[row + word] ^ flip) & ~voxel_mask(first & 31u);
    while bits == 0u && word + 1u < side / 32u {
        word += 1u;
        bits = voxels[row + word] ^ flip;
    }
    return select(32u * word + firstTrailingBit(bits), side, bits == 0u);
}
