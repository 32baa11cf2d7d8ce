// SPDX-License-Identifier: Apache-2.0
// The API's description as a page on which each request can be tried.

import { $, make, on } from './base/dom.js';
import { at } from './base/root.js';
import { tr } from './language/texts.js';

const OPENAPI = '/api/v1/openapi.json';

async function show() {
  const api = await (await fetch(at(OPENAPI))).json();
  $('about').textContent = api.info.description;
  for (const [path, methods] of Object.entries(api.paths)) {
    for (const [method, operation] of Object.entries(methods)) {
      $('operations').append(section(api, path, method, operation));
    }
  }
  const sockets = api['x-websockets'] ?? {};
  for (const [path, about] of Object.entries(sockets)) $('operations').append(socket(api, path, about));
}

/** A WebSocket, with what it sends. */
function socket(api, path, { description, parameters, messages = [] }) {
  const lines = parameters.map(({ name, enum: some, description: text }) => (
    make('li', {}, make('code', { textContent: name }), ` ${[text, some?.join(' | ')].filter(Boolean).join(': ')}`)));
  const sent = messages.map((message) => make('li', {}, make('code', { textContent: fieldsOf(api, message) })));
  return make('details', {},
    make('summary', {},
      make('span', { className: 'method ws', textContent: 'WS' }),
      make('code', { textContent: path }),
      make('span', { className: 'dim', textContent: description.split('\n')[0] })),
    make('pre', { textContent: description, tabIndex: 0 }), make('ul', {}, ...lines), make('ul', {}, ...sent));
}

function section(api, path, method, operation) {
  return make('details', {},
    make('summary', {},
      make('span', { className: `method ${method}`, textContent: method.toUpperCase() }),
      make('code', { textContent: path }),
      make('span', { className: 'dim', textContent: operation.description ?? operation.summary })),
    form(api, path, method, operation));
}

function form(api, path, method, { parameters = [], requestBody, responses }) {
  const out = make('form', {}, ...parameters.map(field));
  const body = requestBody?.content['application/json'].schema;
  if (body) {
    const text = JSON.stringify(example(api, body), null, 2);
    out.append(make('p', { className: 'dim', textContent: tr`body: ${fieldsOf(api, body)}` }),
      make('textarea', { name: 'body', ariaLabel: tr`Body`, value: text, spellcheck: false }));
  }
  const answer = make('pre', { hidden: true, tabIndex: 0 });
  out.append(make('p', { className: 'dim', textContent: tr`answers: ${Object.keys(responses).join(', ')}` }),
    make('button', { textContent: tr`Try it` }), answer);
  on(out, 'submit', async (event) => {
    event.preventDefault();
    answer.hidden = false;
    answer.textContent = await attempt(out, path, method, parameters);
  });
  return out;
}

function field({ name, in: place, required, description = '', schema }) {
  const limits = [schema.enum?.join(' | '), schema.default !== undefined && tr`default ${schema.default}`];
  const about = [description, ...limits].filter(Boolean).join('; ');
  return make('label', {}, make('code', { textContent: name }),
    make('input', { name: `${place}:${name}`, required, value: required ? '1' : '' }),
    make('small', { className: 'dim', textContent: about }));
}

async function attempt(filled, path, method, parameters) {
  let url = path;
  const query = new URLSearchParams();
  for (const { name, in: place } of parameters) {
    const { value } = filled.elements[`${place}:${name}`];
    if (place === 'path') url = url.replace(`{${name}}`, encodeURIComponent(value));
    else if (value) query.set(name, value);
  }
  const body = filled.elements.body?.value;
  const headers = body ? { 'content-type': 'application/json' } : {};
  const text = String(query) ? `${url}?${query}` : url;
  try {
    const answer = await fetch(at(text), { method: method.toUpperCase(), headers, body });
    const came = await textOf(answer);
    return `${method.toUpperCase()} ${text}\n${answer.status} ${answer.statusText}\n${came}`;
  } catch (error) {
    return error.message;
  }
}

/** An answer's text: JSON in lines. */
async function textOf(answer) {
  const isJson = (answer.headers.get('content-type') ?? '').includes('json');
  return isJson ? JSON.stringify(await answer.json(), null, 2) : answer.text();
}

function resolve(api, { oneOf, ...schema }) {
  if (schema.$ref) return api.components.schemas[schema.$ref.split('/').at(-1)];
  return oneOf ? { anyOf: oneOf } : schema;
}

/** A body to begin with. */
function example(api, schema) {
  const { anyOf, properties = {} } = resolve(api, schema);
  if (anyOf) return example(api, anyOf[0]);
  return Object.fromEntries(Object.entries(properties).map(([name, property]) => (
    [name, property.default ?? property.enum?.[0] ?? property.const
      ?? { string: 'small', boolean: true }[property.type] ?? 1])));
}

/** The fields of a body, in words; of each of its variants if it has some. */
function fieldsOf(api, schema) {
  const { anyOf, properties = {}, required = [] } = resolve(api, schema);
  if (anyOf) return anyOf.map((variant) => fieldsOf(api, variant)).join(tr` or `);
  const fields = Object.entries(properties).map(([name, property]) => (
    `${name}${required.includes(name) ? '' : '?'}: ${property.enum?.join(' | ') ?? property.type ?? property.$ref?.split('/').at(-1)}`));
  return `{ ${fields.join(', ')} }`;
}

show();
