// Weights of the filter that is run over a map, along one side.
float blur_weight(int offset) {
  if (parameter_blur_filter == blur_filter_box || parameter_blur == 0) return 1.0;
  float deviations = 2.0 * float(offset) / float(parameter_blur);
  return exp(-0.5 * deviations * deviations);
}
