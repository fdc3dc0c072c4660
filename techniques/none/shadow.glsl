float calculate_shadow(ShadowQuery query) { return 1.0; }
