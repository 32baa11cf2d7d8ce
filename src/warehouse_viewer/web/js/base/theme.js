// SPDX-License-Identifier: Apache-2.0
// Before anything is drawn, so that nothing flashes: what was chosen here last, or the system's.
{
  const light = matchMedia('(prefers-color-scheme: light)').matches;
  document.documentElement.dataset.theme = localStorage.getItem('theme') || (light ? 'light' : 'dark');
}
// Removes the token from the address of a visitor that has been let in: it should not stay there.
if (location.hash.startsWith('#token=')) history.replaceState(null, '', location.pathname);
