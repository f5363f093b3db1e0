import { defineConfig } from 'vite';

// One classic script and one style sheet with fixed names: the server embeds exactly these files, and a classic script, unlike
// a module, also runs from `file://`, which the static gallery needs.
export default defineConfig({
  publicDir: 'static',
  define: { 'process.env.NODE_ENV': '"production"' },
  build: {
    outDir: process.env.STUDIO_BUNDLE ?? '../bundle',
    emptyOutDir: true,
    target: 'es2022',
    minify: true,
    sourcemap: false,
    reportCompressedSize: false,
    lib: {
      entry: 'src/main.tsx',
      name: 'arcadeStudio',
      formats: ['iife'],
      fileName: () => 'app.js',
      cssFileName: 'app',
    },
  },
});
