// Rules of tests/style/run for the pages' modules and for the tests here.
import globals from "globals";

const shared = {
  languageOptions: { ecmaVersion: 2022, sourceType: "module" },
  linterOptions: { reportUnusedDisableDirectives: true },
  rules: {
    "array-callback-return": "error",
    "eqeqeq": "error",
    "no-const-assign": "error",
    "no-dupe-keys": "error",
    "no-eval": "error",
    "no-implied-eval": "error",
    "no-self-compare": "error",
    "no-shadow-restricted-names": "error",
    "no-undef": "error",
    "no-unreachable": "error",
    "no-unused-vars": ["error", { argsIgnorePattern: "^_" }],
    "no-use-before-define": ["error", { functions: false, classes: false }],
    "no-var": "error",
    "prefer-const": "error",
  },
};

export default [
  { ...shared, files: ["**/web/**/*.js"], languageOptions: { ...shared.languageOptions, globals: globals.browser } },
  { ...shared, files: ["**/tests/style/*.mjs"],
    languageOptions: { ...shared.languageOptions, globals: globals.node } },
  // Tests hand functions to the page, so that they know both worlds.
  { ...shared, files: ["**/tests/browser/*.js"],
    languageOptions: { ...shared.languageOptions, globals: { ...globals.browser, ...globals.node } } },
];
