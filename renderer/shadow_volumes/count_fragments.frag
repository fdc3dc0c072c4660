// Counts the fragments of volumes that pass the stencil's mask, exactly, whatever the driver's own
// counters mean. COUNTER, from the preamble, says which place adds up.
layout(early_fragment_tests) in;

layout(std430) buffer FragmentCountBlock { uint fragment_counts[]; };

void main() { atomicAdd(fragment_counts[COUNTER], 1u); }
